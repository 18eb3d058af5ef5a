#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A class graded by GNU parallel: several parts at a time, here or on other machines (parallel's --sshlogin), and then the whole.
#
#     class.sh 2 8 results p3 "handed in"
#     holonom grade p3 --merge results/part-*-of-8.ndjson --out results/scores.csv
#
# usage: class.sh JOBS PARTS FOLDER EXERCISE SUBMISSIONS [OPTION...]
# After Ctrl-C the same command goes on. HOLONOM names the program where it is not in the PATH.
set -eu
jobs=$1
parts=$2
folder=$3
exercise=$4
submissions=$5
shift 5
mkdir -p "$folder"
seq "$parts" | parallel --jobs "$jobs" --halt soon,fail=1 --quote \
    "${HOLONOM:-holonom}" grade "$exercise" "$submissions" "$@" --jobs 1 --shard "{}/$parts" --out "$folder/part-{}-of-$parts.ndjson"
