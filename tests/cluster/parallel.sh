#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A work-precision study by GNU parallel: several parts at a time on one machine, and then the whole.
#
#     parallel.sh 2 8 results four-bar work-precision --time-limit 0
#     holonom merge results/part-*-of-8.json --out results/report.html
#
# usage: parallel.sh JOBS PARTS FOLDER SCENE work-precision [OPTION...]
# More parts than jobs even out what the parts' sizes did not. After Ctrl-C the same command goes on. On other machines:
# parallel's --sshlogin and --return. HOLONOM names the program where it is not in the PATH.
set -eu
jobs=$1
parts=$2
folder=$3
shift 3
mkdir -p "$folder"
seq "$parts" | parallel --jobs "$jobs" --halt soon,fail=1 --quote \
    "${HOLONOM:-holonom}" study "$@" --shard "{}/$parts" --out "$folder/part-{}-of-$parts.json"
