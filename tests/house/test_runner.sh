#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The counting of tests, tried on outputs made for it. Speaks TAP.
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
n=0
bad=0

expect() { # name, expected, actual
    n=$((n + 1))
    if [ "$2" = "$3" ]; then
        echo "ok $n - $1"
    else
        echo "not ok $n - $1"
        echo "# expected '$2', found '$3'"
        bad=1
    fi
}

count() { # exit status; output on standard input
    awk -v status="$1" -v program=p -f tests/tools/count-tests.awk | head -n 1
}

expect 'cmocka: passed, failed and skipped are told apart' '1 1' "$(count 1 <<'X'
[==========] Running 3 test(s).
[ RUN      ] a
[       OK ] a
[ RUN      ] b
[  ERROR   ] --- 1 != 2
[   LINE   ] --- x.c:1: error: Failure!
[  FAILED  ] b
[ RUN      ] c
[  SKIPPED ] c
[==========] 3 test(s) run.
[  PASSED  ] 1 test(s).
[  FAILED  ] 1 test(s), listed below:
[  FAILED  ] b
X
)"
expect 'cmocka: a crash in the middle is a failure, and so are the tests it took along' '1 2' "$(count 139 <<'X'
[==========] Running 5 test(s).
[ RUN      ] a
[       OK ] a
[ RUN      ] b
X
)"
expect 'TAP: parents of subtests are not counted twice' '2 1' "$(count 1 <<'X'
TAP version 13
# Subtest: page
    # Subtest: plays
    ok 1 - plays
    # Subtest: pauses
    not ok 2 - pauses
    1..2
not ok 1 - page
# Subtest: alone
ok 2 - alone
1..2
X
)"
expect 'TAP: planned tests that did not run are a failure' '1 1' "$(printf '1..3\nok 1 - a\n' | count 0)"
expect 'a program that runs no test fails' '0 1' "$(printf 'hello\n' | count 0)"
expect 'a bad exit status alone is a failure' '1 1' "$(printf 'ok 1 - a\n1..1\n' | count 3)"
expect 'a time-out is a failure' '1 1' "$(printf 'ok 1 - a\n' | count 124)"

cat >"$work/crash.sh" <<'X'
kill -SEGV $$
X
expect 'the runner ends with the sum of all programs' '0 passed, 1 failed' \
    "$(sh tests/run-tests.sh "$work/crash.sh" | tail -n 1)"
cat >"$work/meet.sh" <<'X'
# ends when the other one has begun
touch "$0.here"
until [ -e "$1" ]; do sleep 0.05; done
echo "ok 1 - met"
X
for one in a b; do
    other=$([ $one = a ] && echo b || echo a)
    printf 'set -- %s\n. %s\n' "$work/$other.sh.here" "$work/meet.sh" >"$work/$one.sh"
done
expect 'as many programs as asked for run at once' '2 passed, 0 failed' \
    "$(TEST_JOBS=2 TEST_TIMEOUT=60 sh tests/run-tests.sh "$work/a.sh" "$work/b.sh" | tail -n 1)"
printf 'echo "not ok 1 - why"\necho "ok 2 - that # SKIP no network"\n' >"$work/why.sh"
expect 'a failure is told with its output, and again at the end; what was skipped is told' '4' \
    "$(sh tests/run-tests.sh "$work/why.sh" | grep -c -e '^    not ok 1 - why' -e '^     ok 2' -e "^  $work/why.sh: not ok 1" -e '^FAIL ')"

# a program that drives a browser, a server or a terminal is tried again, alone; no other is
cat >"$work/late.mjs" <<'X'
import { existsSync, writeFileSync } from "node:fs";
import { test } from "node:test";
const before = `${process.argv[1]}.ran`;
test("passes the second time", () => {
  if (existsSync(before)) return;
  writeFileSync(before, "");
  throw new Error("too early");
});
X
sh tests/run-tests.sh "$work/late.mjs" >"$work/late.said"
expect 'a browser program that fails beside others is tried again, and the count is that of the second try' \
    '0 1 passed, 0 failed' "$? $(tail -n 1 "$work/late.said")"
expect 'the first failure stays to be read, and the second try is named' '3' \
    "$(grep -c -e '^FAIL ' -e 'too early' -e "^passed only when tried again, alone: $work/late.mjs" "$work/late.said")"
printf 'import os, sys\nbefore = sys.argv[0] + ".ran"\nsecond = os.path.exists(before)\nopen(before, "w").close()\nprint("ok 1 - a" if second else "not ok 1 - a")\nprint("1..1")\n' >"$work/late.py"
expect 'a program that drives a server is tried again too' '1 passed, 0 failed' "$(sh tests/run-tests.sh "$work/late.py" | tail -n 1)"
printf 'if [ -e "$0.ran" ]; then echo "ok 1 - a"; else touch "$0.ran"; echo "not ok 1 - a"; fi\n' >"$work/late.sh"
expect 'a program that computes alone is not' '0 passed, 1 failed' "$(sh tests/run-tests.sh "$work/late.sh" | tail -n 1)"
printf 'import { test } from "node:test";\ntest("never", () => { throw new Error("no"); });\n' >"$work/bad.mjs"
expect 'what fails twice has failed' '0 passed, 1 failed' "$(sh tests/run-tests.sh "$work/bad.mjs" | tail -n 1)"
for k in 1 2 3 4; do cp "$work/bad.mjs" "$work/bad$k.mjs"; done
expect 'where more than three failed none is tried again' '0' \
    "$(sh tests/run-tests.sh "$work"/bad[1-4].mjs | grep -c '^again')"
sh tests/run-tests.sh >/dev/null
expect 'no programs at all is a failure' 1 $?

echo "1..$n"
exit $bad
