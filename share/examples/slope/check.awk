# SPDX-License-Identifier: GPL-3.0-or-later
# Bounds of the slope: what stands, and what must not.
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
$1 == "trimmed" || $1 == "loose" {
    say($4 == 0, $1 ": no disc left")
    say($7 <= 1 && $9 <= 1, $1 ": at most 1 % rose by more than 0.1 d, none by more than 1 d")
    say($8 <= 2, $1 ": at most 2 % moved by more than 2 d")
    say($10 ^ 2 <= 0.09 && $11 ^ 2 <= 0.09, $1 ": crest and toe stay within 0.3 m, half of the smallest d")
}
$1 == "trimmed" { calm = $5; held = $11 }
$1 == "untrimmed" {
    say($5 > 5 * calm, "untrimmed: at first five times as fast as trimmed")
    say(-$11 > 0.1 && -$11 > 10 * (held < 0 ? -held : held), "untrimmed: the toe is pushed up by more than 0.1 m")
}
$1 == "low" { say($7 > 1 && $10 > 0.5, "friction 0.1: the slope fails, the crest sinks by more than 0.5 m") }
END { exit bad }
