#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: run-tests.sh PROGRAM...
# Runs the programs from the project's root, TEST_JOBS at once (all processors), so the longest are best named first. Prints one
# line for each as it ends and the failures in full, and closes with "N passed, N failed". A program speaks cmocka's text or TAP;
# a crash, a time-out, a test that was planned and not run, or no test at all count as a failure. What a test skips stands below
# the line of its program. Exit status 1 if anything failed.
# A browser's program (.mjs) and one that drives servers, terminals or students' programs (.py) shares the machine's time with all
# others. One that failed is run a second time when all have ended, alone. The second try counts; the first stands in full above,
# and a line before the last names what passed only then. Where more than three failed, something is broken: then none is tried
# again.
set -u
export TEST_TIMEOUT="${TEST_TIMEOUT:-600}"

run_one() {
    case $1 in
    *.py) set -- python3 "$1" ;;
    *.mjs | *.js) set -- node --test-reporter=tap "$1" ;;
    *.sh) set -- sh "$1" ;;
    esac
    timeout "$TEST_TIMEOUT" "$@" &
    trap 'kill $!' INT TERM
    wait $!
}

# One program, of the given number: its line is printed in one piece, its count and its failures are left in the folder.
report_one() {
    work=$1 number=$2 program=$3
    start=$(date +%s%N)
    run_one "$program" >"$work/$number.out" 2>&1 </dev/null
    status=$?
    ms=$((($(date +%s%N) - start) / 1000000))
    # prints "passed failed", then a line for each failure
    awk -v status="$status" -v program="$program" -f tests/tools/count-tests.awk "$work/$number.out" >"$work/$number.all"
    read -r ok bad <"$work/$number.all" || {
        ok=0 bad=1
        printf '0 1\n%s: its tests could not be counted\n' "$program" >"$work/$number.all"
    }
    {
        printf '%-4s %4d passed %3d failed %7d ms  %s\n' \
            "$([ "$bad" -eq 0 ] && echo ok || echo FAIL)" "$ok" "$bad" "$ms" "$program"
        # what was not tried is said aloud
        grep '# *SKIP' "$work/$number.out" | sed 's/^/     /'
        [ "$bad" -eq 0 ] || sed 's/^/    /' "$work/$number.out"
    } >"$work/$number.said"
    flock "$work" cat "$work/$number.said"
    sed 1d "$work/$number.all" >"$work/$number.failures"
    echo "$ok $bad" >"$work/$number.count"
}

if [ "${1:-}" = --one ]; then
    report_one "$2" "$3" "$4"
    exit 0
fi

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
n=0
for program in "$@"; do
    n=$((n + 1))
    printf '%04d\0%s\0' "$n" "$program"
done | xargs -0 -r -n 2 -P "${TEST_JOBS:-$(nproc)}" sh "$0" --one "$work"

# the browser's and the driving programs that failed, as "number program" lines
i=0
for program in "$@"; do
    i=$((i + 1))
    number=$(printf '%04d' "$i")
    case $program in
    *.mjs | *.py) grep -qs ' 0$' "$work/$number.count" || echo "$number $program" ;;
    esac
done >"$work/again"

if [ "$(wc -l <"$work/again")" -le 3 ]; then
    while read -r number program; do
        echo "again, alone: $program"
        report_one "$work" "$number" "$program"
        grep -q ' 0$' "$work/$number.count" && echo "$program" >>"$work/second"
    done <"$work/again"
fi

cat "$work"/*.failures >"$work/failures" 2>/dev/null
cat "$work"/*.count 2>/dev/null | awk -v programs=$# '
    { passed += $1; failed += $2 }
    END { print passed + 0, failed + (NR < programs ? programs - NR : 0), programs - NR }' >"$work/sum"
read -r passed failed missing <"$work/sum"
[ "$missing" -eq 0 ] || echo "$missing programs were not run to their end" >>"$work/failures"
if [ $# -eq 0 ]; then
    echo 'no test programs were given' >>"$work/failures"
    failed=1
fi
if [ "$failed" -ne 0 ]; then
    echo 'Failures:'
    sed 's/^/  /' "$work/failures"
fi
[ ! -s "$work/second" ] || sed 's/^/passed only when tried again, alone: /' "$work/second"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
