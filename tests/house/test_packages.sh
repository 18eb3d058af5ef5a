#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What `make run` does on a machine that lacks packages, tried with stand-ins for dpkg-query, apt-get, id and sudo.
# Speaks TAP.
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

# a machine: the packages in $work/installed are there, apt-get installs by writing there
machine() { # user id, packages ...
    rm -rf "$work/bin" "$work/log" "$work/stamp"
    mkdir "$work/bin"
    uid=$1
    shift
    : >"$work/log"
    printf '%s\n' "$@" >"$work/installed"
    for tool in sh mkdir dirname touch env grep cat head; do
        ln -s "$(command -v $tool)" "$work/bin/$tool"
    done
    printf '#!/bin/sh\necho %s\n' "$uid" >"$work/bin/id"
    cat >"$work/bin/dpkg-query" <<'X'
#!/bin/sh
for last; do :; done
grep -qx "$last" "$WORK/installed" && printf installed
X
    cat >"$work/bin/apt-get" <<'X'
#!/bin/sh
echo "apt-get $* (frontend ${DEBIAN_FRONTEND:-none})" >>"$WORK/log"
[ ! -e "$WORK/broken" ]
X
    cat >"$work/bin/sudo" <<'X'
#!/bin/sh
echo "sudo $1" >>"$WORK/log"
[ "$1" = -n ] && shift
exec "$@"
X
    chmod +x "$work/bin"/id "$work/bin"/dpkg-query "$work/bin"/apt-get "$work/bin"/sudo
}

run() {
    env -u DEBIAN_FRONTEND WORK="$work" PATH="$work/bin" tests/tools/packages.sh "$work/stamp" "$@" </dev/null 2>&1
}

machine 0 gcc libpng-dev
expect 'with everything there it says nothing' '' "$(run gcc libpng-dev)"
expect 'and does nothing' '' "$(cat "$work/log")"
expect 'and leaves its stamp' yes "$([ -e "$work/stamp" ] && echo yes)"

machine 0 gcc
expect 'what is missing is said in one line' 'holonom: installing Debian packages: libpng-dev nodejs' \
    "$(run gcc libpng-dev node:nodejs)"
expect 'root installs at once, asking nothing' 'apt-get -qq update (frontend none)
apt-get -qq -y --no-install-recommends install libpng-dev nodejs (frontend noninteractive)' "$(cat "$work/log")"

machine 0 gcc
printf '#!/bin/sh\n' >"$work/bin/node"
chmod +x "$work/bin/node"
expect 'a command that is there needs no package' '' "$(run gcc node:nodejs)"

machine 1000 gcc
run libpng-dev >/dev/null
expect 'others go through sudo, which may not ask without a terminal' 'sudo -n' "$(grep sudo "$work/log" | head -n 1)"

machine 1000 gcc
rm "$work/bin/sudo"
expect 'without sudo the command to give is named' \
    'holonom: not root and no sudo; please run as root: apt-get install libpng-dev' "$(run libpng-dev)"
expect 'and no stamp is left' '' "$([ -e "$work/stamp" ] && echo yes)"

machine 0 gcc
touch "$work/broken"
run libpng-dev >/dev/null
expect 'a failed installation is a failure' yes "$([ $? -ne 0 ] && echo yes)"
expect 'and leaves no stamp' '' "$([ -e "$work/stamp" ] && echo yes)"
rm "$work/broken"

machine 0 gcc
rm "$work/bin/apt-get"
expect 'without apt-get it goes on and says what it hopes for' \
    'holonom: no apt-get here; going on in the hope that these are installed: gcc libpng-dev' "$(run gcc libpng-dev)"

echo "1..$n"
exit $bad
