# SPDX-License-Identifier: GPL-3.0-or-later
# Counts the tests in the output of one program: cmocka's text or TAP (subtests are counted, their parents not).
# usage: awk -v status=EXIT -v program=NAME -f count-tests.awk OUTPUT
# First line: passed and failed. Then one line for each failure.

function fail(what) {
    failures[++failed] = what
}

# a cmocka test that began and never said how it ended
function close_open() {
    if (open != "") fail(program ": " open ": did not finish")
    open = ""
}

# ---- cmocka; the summary repeats names of failed tests, but no test is open then
/^\[=+\] Running [0-9]+ test/ { planned += $3; cmocka = 1 }
/^\[ RUN +\] / { close_open(); open = substr($0, 14); begun++ }
/^\[ +OK \] / && open != "" { passed++; open = "" }
/^\[ +(FAILED|ERROR) +\] / && open != "" { fail(program ": " open); open = "" }
/^\[ +SKIPPED +\] / && open != "" { skipped++; open = "" }
/^\[ +ERROR +\] .*(setup|teardown)/ && open == "" { fail(program ": " $0) }

# ---- TAP: a parent follows its subtests, which are indented deeper
/^ *(not )?ok +[0-9]+/ {
    match($0, /^ */)
    depth = RLENGTH
    if (depth == 0) tap_top++
    is_parent = depth < deepest && subtests[depth] > 0
    subtests[depth] = 0
    if (depth > deepest) deepest = depth
    for (d = depth - 1; d >= 0; d--) subtests[d]++
    bad = $0 ~ /^ *not ok/ && $0 !~ /# *(SKIP|TODO)/
    if (is_parent) next
    if ($0 ~ /# *SKIP/) skipped++
    else if (bad) fail(program ": " $0)
    else passed++
}
/^1\.\.[0-9]+/ { tap_planned = substr($0, 4) + 0; has_plan = 1 }
/^Bail out!/ { fail(program ": " $0) }

END {
    close_open()
    if (cmocka && begun < planned) fail(program ": " planned - begun " of " planned " tests were not run")
    if (has_plan && tap_top < tap_planned) fail(program ": " tap_planned - tap_top " planned tests were not run")
    if (status == 124) fail(program ": ran out of time")
    else if (status != 0 && failed == 0) fail(program ": ended with status " status)
    if (passed + failed == 0) fail(program ": no test was run")
    print passed + 0, failed + 0
    for (i = 1; i <= failed; i++) print failures[i]
}
