# SPDX-License-Identifier: GPL-3.0-or-later
# Finds functions with more than 52 lines between their braces, in C sources as clang-format lays them out.
# usage: awk -f check-functions.awk FILES
# Prints file:line for each; exit 1 if there is any.

FNR == 1 { begun = 0 }

begun && /^}$/ {
    if (FNR - begun - 1 > 52) {
        printf "%s:%d: a function of %d lines, 52 are allowed\n", FILENAME, begun, FNR - begun - 1
        faults++
    }
    begun = 0
    next
}

!begun && /\) \{$/ { begun = FNR }

END { exit faults > 0 }
