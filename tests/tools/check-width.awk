# SPDX-License-Identifier: GPL-3.0-or-later
# Finds lines above 100 columns in C sources and headers, comments included; a column is a character, not a byte.
# usage: awk -f check-width.awk FILES
# Prints file:line for each; exit 1 if there is any.

{
    text = $0
    # bytes 10xxxxxx continue a character of UTF-8
    if (length(text) > 100) gsub(/[\200-\277]/, "", text)
    if (length(text) > 100) {
        printf "%s:%d: %d columns, 100 are allowed\n", FILENAME, FNR, length(text)
        faults++
    }
}

END { exit faults > 0 }
