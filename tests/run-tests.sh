#!/bin/sh
# usage: run-tests.sh PROGRAM...
# Runs each program from the project's root, prints one line for it and the failures in full, and ends with
# "N passed, N failed". A program speaks cmocka's text or TAP; a crash, a time-out, a test that was planned
# and not run, or no test at all count as a failure. What a test skips stands below the line of its program. Exit status 1 if
# anything failed.
set -u
LIMIT=${TEST_TIMEOUT:-600}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
: >"$work/failures"
passed=0
failed=0

run_one() {
    case $1 in
    *.py) timeout "$LIMIT" python3 "$1" ;;
    *.mjs | *.js) timeout "$LIMIT" node --test-reporter=tap "$1" ;;
    *.sh) timeout "$LIMIT" sh "$1" ;;
    *) timeout "$LIMIT" "$1" ;;
    esac
}

for program in "$@"; do
    start=$(date +%s%N)
    run_one "$program" >"$work/out" 2>&1 </dev/null
    status=$?
    ms=$((($(date +%s%N) - start) / 1000000))
    # prints "passed failed", then a line for each failure
    awk -v status="$status" -v program="$program" -f tests/count-tests.awk "$work/out" >"$work/count"
    read -r ok bad <"$work/count"
    passed=$((passed + ok))
    failed=$((failed + bad))
    printf '%-4s %4d passed %3d failed %7d ms  %s\n' \
        "$([ "$bad" -eq 0 ] && echo ok || echo FAIL)" "$ok" "$bad" "$ms" "$program"
    # what was not tried is said aloud
    grep '# *SKIP' "$work/out" | sed 's/^/     /'
    if [ "$bad" -ne 0 ]; then
        sed 's/^/    /' "$work/out"
        sed 1d "$work/count" >>"$work/failures"
    fi
done

if [ $# -eq 0 ]; then
    echo 'no test programs were given' >>"$work/failures"
    failed=1
fi
if [ "$failed" -ne 0 ]; then
    echo 'Failures:'
    sed 's/^/  /' "$work/failures"
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
