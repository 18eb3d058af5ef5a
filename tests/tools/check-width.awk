# SPDX-License-Identifier: GPL-3.0-or-later
# Finds lines above 100 columns in C sources and headers, comments included, and files above 600 lines; a column is a character,
# not a byte.
# usage: awk -f check-width.awk FILES
# Prints file:line for each line, and each file with its length; exit 1 if there is any.

# the file that ends, before the first line of the next
FNR == 1 { end_file() }

{
    file = FILENAME
    lines = FNR
    text = $0
    # bytes 10xxxxxx continue a character of UTF-8
    if (length(text) > 100) gsub(/[\200-\277]/, "", text)
    if (length(text) > 100) {
        printf "%s:%d: %d columns, 100 are allowed\n", FILENAME, FNR, length(text)
        faults++
    }
}

END {
    end_file()
    exit faults > 0
}

function end_file() {
    if (lines > 600) {
        printf "%s: %d lines, 600 are allowed; split it where a concept ends\n", file, lines
        faults++
    }
}
