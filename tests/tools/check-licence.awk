# SPDX-License-Identifier: GPL-3.0-or-later
# Every source names its licence in its first line, or in the second below "#!".
# usage: awk -f check-licence.awk FILES
# Prints each file that does not; exit 1 if there is any.

FNR == 1 { files[++count] = FILENAME; first = $0 }
FNR == 1 || (FNR == 2 && first ~ /^#!/) {
    if (/SPDX-License-Identifier: GPL-3\.0-or-later/) named[FILENAME] = 1
}

END {
    for (i = 1; i <= count; i++)
        if (!(files[i] in named)) {
            printf "%s: the first line must say SPDX-License-Identifier: GPL-3.0-or-later\n", files[i]
            faults++
        }
    exit faults > 0
}
