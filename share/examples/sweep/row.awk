# The row of a run: loads in the axes of the platform, from the first third of the record on. The ice drifts along x of
# the run and towards `angle` in the axes of the platform:
#     fX = fx cos a - fy sin a, fY = fx sin a + fy cos a
# The moments are about the reference of the scene.
BEGIN { pi = atan2(0, -1); c = cos(angle * pi / 180); s = sin(angle * pi / 180) }
/^#report warning: (the field is too narrow|a jam)/ { jam = 1 }
/^#stopped/ { stopped = 1 }
/^[0-9]/ { # a row for each part
    if (!n || $1 != t[n]) t[++n] = $1
    fx[n] += $3; fy[n] += $4; mx[n] += $6; my[n] += $7
}
END {
    if (stopped || !n) { print "row.awk: the run has stopped early" >"/dev/stderr"; exit 1 }
    for (k = 1; k <= n; k++) {
        if (t[k] < t[n] / 3) continue
        rows++
        X = fx[k] * c - fy[k] * s; Y = fx[k] * s + fy[k] * c
        meanX += X; meanY += Y
        shear = sqrt(X * X + Y * Y); moment = sqrt(mx[k] * mx[k] + my[k] * my[k])
        if (shear > most) { most = shear; at = t[k] }
        if (moment > turn) turn = moment
    }
    printf "%g\t%g\t%g\t%d\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%s\n", angle, speed, thickness, seed, meanX / rows / 1e3, \
        meanY / rows / 1e3, most / 1e3, at, turn / 1e6, jam ? "jam" : "-"
}
