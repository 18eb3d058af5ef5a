#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packages.sh STAMP ENTRY...
# Installs the Debian packages that are missing, asking nothing, and says first in one line which ones.
# An entry is a package name, or `command:package`: then the command, however it got here, is enough.
# STAMP is written when everything is there, so that the next call is not even made.
set -eu
stamp=$1
shift

is_there() {
    case $1 in
    *:*) command -v "${1%%:*}" >/dev/null 2>&1 ;;
    *) [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ] ;;
    esac
}

if ! command -v apt-get >/dev/null 2>&1; then
    echo "holonom: no apt-get here; going on in the hope that these are installed: $*" >&2
    exit 0
fi

missing=
for entry in "$@"; do
    is_there "$entry" || missing="$missing ${entry##*:}"
done

if [ -n "$missing" ]; then
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            echo "holonom: not root and no sudo; please run as root: apt-get install$missing" >&2
            exit 1
        fi
        # a password can be asked for at a terminal only
        if [ -t 0 ]; then as_root=sudo; else as_root='sudo -n'; fi
    fi
    echo "holonom: installing Debian packages:$missing"
    $as_root apt-get -qq update
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install \
        $missing </dev/null
fi
mkdir -p "$(dirname "$stamp")"
touch "$stamp"
