# The row of a run: loads in the axes of the platform, from the first third of the record on. The columns of these axes are
# those of dem-solve --direction; at an angle of 0 there are none, as they are those of the run. The moments are about the
# reference of the scene.
BEGIN { FS = "\t" }
/^#report warning: (the field is too narrow|a jam)/ { jam = 1 }
/^#stopped/ { stopped = 1 }
/^t\[/ { for (k = 1; k <= NF; k++) { sub(/\[.*/, "", $k); at_name[$k] = k } }
function column(name) { return $(name "_platform" in at_name ? at_name[name "_platform"] : at_name[name]) }
/^[0-9]/ { # a row for each part
    if (!n || $1 != t[n]) t[++n] = $1
    fx[n] += column("fx"); fy[n] += column("fy"); mx[n] += column("mx"); my[n] += column("my")
}
END {
    if (stopped || !n) { print "row.awk: the run has stopped early" >"/dev/stderr"; exit 1 }
    for (k = 1; k <= n; k++) {
        if (t[k] < t[n] / 3) continue
        rows++
        meanX += fx[k]; meanY += fy[k]
        shear = sqrt(fx[k] * fx[k] + fy[k] * fy[k]); moment = sqrt(mx[k] * mx[k] + my[k] * my[k])
        if (shear > most) { most = shear; at = t[k] }
        if (moment > turn) turn = moment
    }
    printf "%g\t%g\t%g\t%d\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%s\n", angle, speed, thickness, seed, meanX / rows / 1e3, \
        meanY / rows / 1e3, most / 1e3, at, turn / 1e6, jam ? "jam" : "-"
}
