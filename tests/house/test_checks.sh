#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The checks of `make check-house`: the tree passes them, and each finds a fault that is planted for it. Speaks TAP.
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
n=0
bad=0
here=$PWD

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

# a make of its own, whoever runs the tests
house() { # folder, target
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make -s --no-print-directory -C "$1" "$2" 2>&1 | grep -v '^make'
}

# ---- the tree itself ----
for check in layers names circles licence width functions contracts; do
    expect "check-$check finds nothing in the tree" '' "$(house . check-$check | head -n 20)"
done

# ---- layers and rooms: faults planted in a copy of the tree ----
cp -r Makefile core server "$work"
mkdir -p "$work/tests" && cp -r tests/tools tests/support "$work/tests"
expect 'layers: the copy is as good as the tree' '' "$(house "$work" check-layers)"
printf '#include "session/model/model.h"\n' >"$work/core/base/planted.c"
expect 'layers: an include of an upper layer is found with file and line' \
    'core/base/planted.c:1: base must not include session: session/model/model.h' "$(house "$work" check-layers)"
rm "$work/core/base/planted.c"
printf '\n#include "dynamics/reactions/reactions.h"\n' >"$work/core/dynamics/compile/planted.c"
expect 'rooms: an include of an upper room is found with file and line' \
    'core/dynamics/compile/planted.c:2: room dynamics/compile must not include dynamics/reactions: dynamics/reactions/reactions.h' \
    "$(house "$work" check-layers)"
rm "$work/core/dynamics/compile/planted.c"
mkdir "$work/core/dynamics/cellar" && echo >"$work/core/dynamics/cellar/planted.c"
expect 'rooms: a room that the table lacks is found' \
    "core/dynamics/cellar/planted.c:1: the room 'cellar' of dynamics is not in the table of the Makefile" \
    "$(house "$work" check-layers)"
rm -r "$work/core/dynamics/cellar"

layers() { # prints the faults of the files in $work, by a table of its own
    (cd "$work" && awk -v layers='base: expr:base session:expr,base render:base server:session,base' \
        -f "$here/tests/tools/check-layers.awk" "$@")
}
mkdir -p "$work/core/base" "$work/core/render" "$work/core/session"
printf '#include "base/a.h"\n#include <math.h>\n' >"$work/core/base/good.c"
printf '#include <GL/osmesa.h>\n' >"$work/core/render/gl.c"
printf '\n#include <GL/gl.h>\n' >"$work/core/session/y.c"
printf '#include "graph.h"\n' >"$work/core/base/short.c"
expect 'layers: below and libc are allowed' '' "$(layers core/base/good.c core/render/gl.c)"
expect 'layers: a library outside its layer is found' \
    'core/session/y.c:2: session must not include <GL/gl.h>: only render may' "$(layers core/session/y.c)"
expect 'layers: a header without its layer is found' \
    'core/base/short.c:1: write "layer/file.h", not "graph.h"' "$(layers core/base/short.c)"
layers core/base/short.c >/dev/null
expect 'layers: a fault is an exit status' 1 $?

# ---- width ----
{
    printf '%0100d\n' 0
    printf '// '
    i=0 && while [ $i -lt 97 ]; do printf '\303\244' && i=$((i + 1)); done
    printf '\n// %098d\n' 0
} >"$work/wide.c"
expect 'width: a line of 101 columns is found, 100 columns of any letters are not' \
    "$work/wide.c:3: 101 columns, 100 are allowed" "$(LC_ALL=C awk -f tests/tools/check-width.awk "$work/wide.c")"

i=0 && while [ $i -lt 600 ]; do echo '//' && i=$((i + 1)); done >"$work/full.c"
{ cat "$work/full.c" && echo '//'; } >"$work/long.c"
expect 'width: a file of 601 lines is found, one of 600 is not' \
    "$work/long.c: 601 lines, 600 are allowed; split it where a concept ends" \
    "$(awk -f tests/tools/check-width.awk "$work/long.c" "$work/full.c")"

# ---- functions ----
for lines in 52 53; do
    printf 'static void of_%d(void) {\n' $lines
    i=0 && while [ $i -lt $lines ]; do echo '    if (x) {' && i=$((i + 1)); done
    printf '}\n\n'
done >"$work/long.c"
expect 'functions: one of 53 lines is found, one of 52 is not' \
    "$work/long.c:56: a function of 53 lines, 52 are allowed" "$(awk -f tests/tools/check-functions.awk "$work/long.c")"

# ---- contracts ----
cat >"$work/said.h" <<'EOF'
/// Both.
int hn_a(void);
int hn_b(void);

int hn_c(void); ///< behind it
typedef int (*hn_not_one)(void);
EOF
cat >"$work/unsaid.h" <<'EOF'
/// Said.
int hn_a(void);

HN_MUST_CHECK hn_status hn_b(int a,
                             int b);
EOF
expect 'contracts: a comment above, above the paragraph, or behind it is one' '' \
    "$(awk -f tests/tools/check-contracts.awk "$work/said.h")"
expect 'contracts: a function without a comment is found' \
    "$work/unsaid.h:4: hn_b has no comment that says what it does" \
    "$(awk -f tests/tools/check-contracts.awk "$work/unsaid.h")"

# ---- names ----
mkdir -p "$work/names" && touch "$work/names/both.c" "$work/names/both.h" "$work/names/row.c" "$work/names/lost.c"
names() { # the list of exceptions on standard input
    cat >"$work/names.txt"
    python3 tests/tools/check-names.py "$work/names.txt" "$work"/names/*.c
}
expect 'names: a source without a header of its name is found' \
    "$work/names/lost.c: no header of the same name; give it one, or name it in $work/names.txt with the reason" \
    "$(echo "*/row.c: a row of a registry" | names)"
expect 'names: an exception that excuses nothing is found' \
    "$work/names.txt: '*/gone.c' excuses no source any more; take the line out" \
    "$(printf '*/row.c: a row\n*/lost.c: lost\n*/gone.c: gone\n' | names)"

# ---- circles, and arrows between rooms that no include shows ----
mkdir -p "$work/src/core/low" "$work/src/core/high/cellar" "$work/src/core/high/roof" "$work/out/core/low" \
    "$work/out/core/high/cellar" "$work/out/core/high/roof"
compile() { # place, text
    printf '%s\n' "$2" | gcc -x c -c -o "$work/out/core/$1.o" -
}
compile low/a 'int b(void); int a(void) { return b(); }'
compile low/b 'int a(void); int b(void) { return a(); }'
compile high/cellar/c 'int d(void); int c(void) { return d(); }'
compile high/roof/d 'int a(void); int d(void) { return a(); }'
circles() { # the list of what is allowed on standard input
    cat >"$work/circles.txt"
    python3 tests/tools/check-circles.py --layers 'low: high:low' --rooms 'high.cellar: high.roof:cellar' \
        --natural "$work/circles.txt" --out "$work/out" "$work"/out/core/*/*.o "$work"/out/core/*/*/*.o
}
UP='core/high/cellar/c.c: uses d of core/high/roof/d.c: room cellar may not use room roof'
expect 'circles: a circle and an arrow to an upper room are found' "circle: core/low/a.c core/low/b.c
$UP" "$(circles </dev/null)"
expect 'circles: a circle that is named may stay' "$UP" "$(echo 'core/low/b.c core/low/a.c: they need each other' | circles)"
expect 'circles: a source that may reach upwards is named' '' \
    "$(printf 'core/low/b.c core/low/a.c: they need each other\nup core/high/cellar/c.c: its table\n' | circles)"
compile low/b 'int b(void) { return 1; }'
expect 'circles: a line that allows what is not there is found' \
    "$work/circles.txt: is no circle (any more): core/low/a.c core/low/b.c" \
    "$(printf 'core/low/b.c core/low/a.c: they need each other\nup core/high/cellar/c.c: its table\n' | circles)"

# ---- licence ----
printf '// SPDX-License-Identifier: GPL-3.0-or-later\n' >"$work/good.c"
printf '#!/bin/sh\n# SPDX-License-Identifier: GPL-3.0-or-later\n' >"$work/good.sh"
printf 'int x;\n// SPDX-License-Identifier: GPL-3.0-or-later\n' >"$work/late.c"
expect 'licence: a source that does not begin with it is found' \
    "$work/late.c: the first line must say SPDX-License-Identifier: GPL-3.0-or-later" \
    "$(awk -f tests/tools/check-licence.awk "$work/good.c" "$work/good.sh" "$work/late.c")"

echo "1..$n"
exit $bad
