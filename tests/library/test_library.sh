#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What `make install` installs, and a program that uses nothing else. Speaks TAP.
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
        printf '# expected: %s\n# found:    %s\n' "$2" "$3"
        bad=1
    fi
}

# a make of its own, whoever runs the tests
env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make -s --no-print-directory install PREFIX="$work" >"$work/log" 2>&1
expect 'make install succeeds' 0 $? || cat "$work/log"
export PKG_CONFIG_PATH="$work/lib/pkgconfig"
home=$(pkg-config --variable=home holonom)

expect 'one header is installed, and no internal one' 'holonom.h' "$(cd "$work/include" && find . -type f | sed 's|^\./||')"
expect 'scenes and page are where pkg-config says' yes "$([ -d "$home/lessons" ] && [ -d "$home/web" ] && echo yes)"
expect 'the manual and the completion of three shells are installed' '5 files' \
    "$(cd "$work/share" && ls man/man1/holonom.1 bash-completion/completions/holonom zsh/site-functions/_holonom \
        fish/vendor_completions.d/holonom.fish holonom/python/holonom.py 2>/dev/null | wc -l) files"
expect 'the only C source that is installed is the example' 'example.c' "$(find "$work/share" -name '*.[ch]' -printf '%f\n')"
expect 'the installed program runs a shipped scene' 0 \
    "$(cd / && "$work/bin/holonom" inspect four-bar >/dev/null 2>&1; echo $?)"

cp tests/library/example.c "$work"
# shellcheck disable=SC2046
gcc -std=c17 -Wall -Wextra -Wpedantic -Wconversion -Wstrict-prototypes -Werror "$work/example.c" \
    $(pkg-config --cflags --libs holonom) -o "$work/example" >"$work/log" 2>&1
expect 'the example compiles with what pkg-config prints, without a warning' '' "$(cat "$work/log")"
printf '#include <holonom.h>\nint main() { return HOLONOM_OK; }\n' >"$work/face.cpp"
expect 'the header is C++ too' '' "$(g++ -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$work/include" "$work/face.cpp" 2>&1)"

(cd / && HOLONOM_HOME="$home" "$work/example") >"$work/out" 2>"$work/err"
expect 'the example runs' '0 ' "$? $(cat "$work/err")"
expect 'it finds the installed scenes without being told' "0 " \
    "$(cd / && env -u HOLONOM_HOME "$work/example" 2>&1 >/dev/null | head -n 1; cd / && env -u HOLONOM_HOME "$work/example" >/dev/null 2>&1; echo $?) "
expect 'pkg-config and the program name one version' "$(build/holonom --version | cut -d' ' -f2)" "$(pkg-config --modversion holonom)"
expect 'the module finds the command that was installed with it' 'four-bar' \
    "$(cd / && env -u HOLONOM PATH=/usr/bin:/bin PYTHONPATH="$work/share/holonom/python" python3 -c 'import holonom; print(holonom.run("four-bar", "index1@rk4:h=1e-2", time=0.1).document["scene"])' 2>&1 | tail -n 1)"
expect 'it counts the degrees of freedom' '3 coordinates - 2 constraints + 0 redundant = 1 degree of freedom' \
    "$(head -n 1 "$work/out")"
# the same numbers from the command line, to the six digits that the example prints
said=$(sed -n 's/^t = 2.0 s: th1 = \([-0-9.]*\) rad.*/\1/p' "$work/out")
known=$(build/holonom run four-bar --set l1=0.4 --method projection@rk4:h=1e-3 --time 2 --at 2 --json |
    python3 -c 'import json,sys; print("%.6f" % json.load(sys.stdin)["samples"]["q"][0][0])')
expect 'its angle is that of the program' "$known" "$said"
gap() { # the gap that the example prints for a method
    sed -n "s/^$1[^ ]* *gap \([^ ]*\) m.*/\1/p" "$work/out"
}
expect 'the loop of index-1 opens, Baumgarte keeps it within a millimetre, projection closes it' yes \
    "$(awk -v a="$(gap index1)" -v b="$(gap baumgarte)" -v c="$(gap projection)" \
        'BEGIN { if (a > 5e-3 && b < 1e-3 && b > 1e-9 && c < 1e-12 && c != "") print "yes" }')"

expect 'a fault that is in no place of an input begins with its message' 'no folder' \
    "$(cd / && HOLONOM_HOME=/nowhere "$work/example" 2>&1 >/dev/null | head -n 1 | cut -c 1-9)"

sed 's/"four-bar"/"four-baar"/' "$work/example.c" >"$work/wrong.c"
# shellcheck disable=SC2046
gcc "$work/wrong.c" $(pkg-config --cflags --libs holonom) -o "$work/wrong"
expect 'an unknown scene is reported with the nearest name' "/scene: no shipped scene is called 'four-baar' (did you mean 'four-bar'?)" \
    "$(HOLONOM_HOME="$home" "$work/wrong" 2>&1)"

echo "1..$n"
exit $bad
