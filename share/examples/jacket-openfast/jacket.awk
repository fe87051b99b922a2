# SPDX-License-Identifier: GPL-3.0-or-later
# jacket.awk -- writes the jacket as an input file of SubDyn.
#
# Dimensions after the reference jacket of Vorpahl, Popko and Kaufer, Description of a basic model of the "UpWind
# reference jacket" for code comparison in the OC4 project, Fraunhofer IWES (2011), rounded: legs of 1.2 m from 12 m
# apart on the ground at -50 m to 8 m apart at the top, four bays of X-braces of 0.8 m, and braces in the mud. The
# transition piece, tower and turbine are four masses on a stiff frame.
function half(z) { return 6.0 + (z + 50.0) / 66.0 * (4.0 - 6.0) }
function joint(x, y, z) { jx[++joints] = x; jy[joints] = y; jz[joints] = z; return joints }
function member(a, b, set) { ma[++members] = a; mb[members] = b; ms[members] = set }
function section(d, t, name) { sd[++sets] = d; st[sets] = t; sn[sets] = name; return sets }
BEGIN {
    n = split("-50 -43 -24.6 -8.9 4.4 16", level, " ")
    sx[1] = -1; sy[1] = -1; sx[2] = 1; sy[2] = -1; sx[3] = 1; sy[3] = 1; sx[4] = -1; sy[4] = 1
    for (c = 1; c <= 4; c++) leg[c] = section(1.2, 0.05, "leg " c)
    for (k = 2; k < n; k++) brace[k] = section(0.8, 0.02, "braces " k - 1)
    mud = section(0.8, 0.02, "mud braces")
    deck = section(1.2, 0.04, "frame of the deck")
    for (k = 1; k <= n; k++)
        for (c = 1; c <= 4; c++) {
            at[k, c] = joint(sx[c] * half(level[k]), sy[c] * half(level[k]), level[k])
            if (k > 1) member(at[k - 1, c], at[k, c], leg[c])
        }
    for (c = 1; c <= 4; c++) {
        d = c % 4 + 1
        member(at[2, c], at[2, d], mud)
        member(at[n, c], at[n, d], deck)
        for (k = 2; k < n; k++) { # the braces of a bay cross where its diagonals do
            lo = half(level[k]); hi = half(level[k + 1]); s = lo / (lo + hi)
            x = joint(jx[at[k, c]] + s * (jx[at[k + 1, d]] - jx[at[k, c]]), jy[at[k, c]] + s * (jy[at[k + 1, d]] - jy[at[k, c]]),
                level[k] + s * (level[k + 1] - level[k]))
            member(at[k, c], x, brace[k]); member(x, at[k + 1, d], brace[k])
            member(at[k, d], x, brace[k]); member(x, at[k + 1, c], brace[k])
        }
    }
    print "----------- SubDyn MultiMember Support Structure Input File ---------------------------"
    print "A jacket after the OC4 reference jacket, with masses for the turbine; written by jacket.awk."
    print "---- STRUCTURE JOINTS ----------------------------------------------------------------"
    printf "%10d   NJoints     - Number of joints (-)\n", joints
    print "JointID   JointXss   JointYss   JointZss   JointType   JointDirX   JointDirY   JointDirZ   JointStiff"
    print "  (-)       (m)        (m)        (m)         (-)         (-)         (-)         (-)       (Nm/rad)"
    for (k = 1; k <= joints; k++) printf "%5d %12.5f %12.5f %12.5f  1  0.0  0.0  0.0  0.0\n", k, jx[k], jy[k], jz[k]
    print "------------------- BASE REACTION JOINTS ----------------------------------------------"
    print "             4   NReact      - Number of Joints with reaction forces"
    print "RJointID   RctTDXss    RctTDYss    RctTDZss    RctRDXss    RctRDYss    RctRDZss     SSIfile"
    print "  (-)       (flag)      (flag)      (flag)      (flag)      (flag)      (flag)      (string)"
    for (c = 1; c <= 4; c++) printf "%5d  1  1  1  1  1  1  \"\"\n", at[1, c]
    print "----------------------------------- MEMBERS -------------------------------------------"
    printf "%10d   NMembers    - Number of members (-)\n", members
    print "MemberID   MJointID1   MJointID2   MPropSetID1   MPropSetID2   MType   MSpin/COSMID"
    print "  (-)         (-)         (-)          (-)           (-)        (-)      (deg/-)"
    for (k = 1; k <= members; k++) printf "%5d %8d %8d %8d %8d  1c  0\n", k, ma[k], mb[k], ms[k], ms[k]
    print "------------------ CIRCULAR BEAM CROSS-SECTION PROPERTIES -----------------------------"
    printf "%10d   NPropSetsCyl   - Number of structurally unique cross-sections\n", sets
    print "PropSetID     YoungE          ShearG          MatDens          XsecD           XsecT"
    print "  (-)         (N/m2)          (N/m2)          (kg/m3)           (m)             (m)"
    for (k = 1; k <= sets; k++) printf "%5d   2.1e11   8.08e10   7850.0   %8.4f   %8.4f   ! %s\n", k, sd[k], st[k], sn[k]
    print "---------------------- JOINT ADDITIONAL CONCENTRATED MASSES ---------------------------"
    print "             4   NCmass      - Number of joints with concentrated masses"
    print "CMJointID   JMass      JMXX      JMYY      JMZZ      JMXY   JMXZ   JMYZ   MCGX   MCGY   MCGZ"
    print "  (-)       (kg)     (kg*m^2)  (kg*m^2)  (kg*m^2)    ...     ...    ...    (m)    (m)    (m)"
    for (c = 1; c <= 4; c++) printf "%5d   315000   0   0   0   0   0   0   0   0   0\n", at[n, c]
    print "END of input file (the word \"END\" must appear in the first 3 columns of this last line)"
}
