# SPDX-License-Identifier: GPL-3.0-or-later
# Lee's frame as a model of kind `members`: awk -v PIECES=10 -f lee.awk, pieces of a member in steps of 5.
BEGIN {
    print "#members 1"
    print "# column and beam of 120, E = 720, A = 6, I = 2, hinged at both ends; load down at 24 from the corner"
    print "section s 4320 1440 1440 1e3"
    print "node foot 0 0 0\nnode knee 0 0 120\nnode at 24 0 120\nnode end 120 0 120"
    printf "member column foot knee s %d\nmember left knee at s %d\nmember right at end s %d\n", PIECES, PIECES / 5, PIECES / 5 * 4
    print "fix foot pinned rx rz\nfix end pinned rx rz\nfix knee y rx rz\nfix at y rx rz\nload at 0 0 -1"
}
