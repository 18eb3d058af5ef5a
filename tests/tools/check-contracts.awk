# SPDX-License-Identifier: GPL-3.0-or-later
# Every function that a header declares has a contract: a comment above it, behind it, or above the
# first line of its paragraph.
# usage: awk -f check-contracts.awk HEADERS

function finish() {
    if (declaration ~ /;/ && declaration !~ /\/\/\// && !said) {
        match(declaration, /(hn|holonom)_[a-z0-9_]+\(/)
        printf "%s:%d: %s has no comment that says what it does\n", file, line,
            substr(declaration, RSTART, RLENGTH - 1)
        bad = 1
    }
    declaration = ""
}

FNR == 1 { finish(); file = FILENAME; said = 0 }
/^[ \t]*$/ { said = 0 }
/^[ \t]*\/\// { said = 1 }

declaration != "" { declaration = declaration $0 }
declaration == "" && !/^(static|typedef|extern|enum|struct [a-z_0-9]+ \{)/ &&
    /^[A-Za-z_][A-Za-z_0-9 *]*[ *](hn|holonom)_[a-z0-9_]+\(/ { declaration = $0; line = FNR }
declaration ~ /[;{]/ { finish() }

END { finish(); exit bad }
