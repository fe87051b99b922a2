# Rows of all runs, and a mean over the seeds of each angle, speed and thickness, seed "all".
BEGIN {
    print "angle[deg]\tspeed[m/s]\tthickness[m]\tseed\tmean_fX[kN]\tmean_fY[kN]\tlargest_shear[kN]\tat[s]\tlargest_moment[MN.m]\tjam"
}
{
    print
    key = $1 "\t" $2 "\t" $3
    if (!(key in n)) order[++keys] = key
    n[key]++; X[key] += $5; Y[key] += $6; F[key] += $7; M[key] += $9
    if ($10 == "jam") jam[key] = 1
}
END {
    for (k = 1; k <= keys; k++) {
        key = order[k]
        printf "%s\tall\t%.6g\t%.6g\t%.6g\t-\t%.6g\t%s\n", key, X[key] / n[key], Y[key] / n[key], F[key] / n[key], \
            M[key] / n[key], key in jam ? "jam" : "-"
    }
}
