// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/submission_text.h"

#include "grade/parts/latex_letters.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>

// ---- encodings ----

static void put_utf8(hn_strbuf *out, uint32_t c) {
    char b[4];
    size_t n = 0;
    if (c < 0x80) {
        b[n++] = (char)c;
    } else if (c < 0x800) {
        b[n++] = (char)(0xc0 | c >> 6);
    } else if (c < 0x10000) {
        b[n++] = (char)(0xe0 | c >> 12);
        b[n++] = (char)(0x80 | (c >> 6 & 0x3f));
    } else {
        b[n++] = (char)(0xf0 | c >> 18);
        b[n++] = (char)(0x80 | (c >> 12 & 0x3f));
        b[n++] = (char)(0x80 | (c >> 6 & 0x3f));
    }
    if (c >= 0x80) {
        b[n++] = (char)(0x80 | (c & 0x3f));
    }
    hn_strbuf_add_n(out, b, n);
}

static hn_status decode_utf16(hn_strbuf *out, const unsigned char *x, size_t n, bool big) {
    if (n % 2) {
        return HN_ERR_INPUT;
    }
    for (size_t i = 0; i < n; i += 2) {
        uint32_t c = (uint32_t)(x[i + big] | x[i + !big] << 8);

        // two halves make one character beyond the first 65,536
        if (c >= 0xd800 && c < 0xdc00 && i + 3 < n) {
            const uint32_t low = (uint32_t)(x[i + 2 + big] | x[i + 2 + !big] << 8);
            if (low >= 0xdc00 && low < 0xe000) {
                c = 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
                i += 2;
            }
        }
        if (c >= 0xd800 && c < 0xe000) {
            return HN_ERR_INPUT;
        }
        put_utf8(out, c);
    }
    return out->failed ? HN_ERR_MEMORY : HN_OK;
}

hn_status hn_submission_decode(hn_strbuf *out, const char *bytes, size_t n, bool *utf16) {
    const unsigned char *x = (const unsigned char *)bytes;
    const bool little = n >= 2 && x[0] == 0xff && x[1] == 0xfe;
    const bool big = n >= 2 && x[0] == 0xfe && x[1] == 0xff;
    *utf16 = true;
    if (little || big) {
        return decode_utf16(out, x + 2, n - 2, big);
    }
    if (n >= 2 && (x[0] == 0) != (x[1] == 0)) { // no mark; JSON begins with two ASCII characters
        return decode_utf16(out, x, n, x[0] == 0);
    }

    *utf16 = false;
    const size_t mark = n >= 3 && memcmp(x, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    hn_strbuf_add_n(out, bytes + mark, n - mark);
    return out->failed ? HN_ERR_MEMORY : HN_OK;
}

// ---- slips ----

/// Commands of LaTeX whose first letter makes an escape of JSON: \b \f \n \r \t \u.
static const char *const COMMANDS[] = {
    "bar", "begin", "beta", "big",   "bigl",  "bigr", "bm",  "boldsymbol", "frac", "right",
    "tan", "tanh",  "text", "tfrac", "times", "top",  "rho", "nu",         NULL};

/// Returns whether the backslash at `at` begins a command of LaTeX where JSON would read an escape,
/// or nothing that it knows. `end` is that of the text, which is no string of C.
static bool is_latex(const char *at, const char *end) {
    char word[16] = "";
    for (size_t i = 0; i + 1 < sizeof word && at + 1 + i < end && isalpha((unsigned char)at[1 + i]);
         i++) {
        word[i] = at[1 + i];
    }
    if (word[0] && strchr("bfnrtu", word[0])) {
        return hn_latex_is_letter(word) || hn_latex_is_word(word, COMMANDS);
    }
    return at + 1 < end && (word[0] || strchr(",;:! ()[]{}|", at[1]));
}

/// Copies the string that begins at `at`; returns the character behind it.
static const char *copy_string(hn_strbuf *out, const char *at, const char *end, int *backslashes) {
    hn_strbuf_add_n(out, at++, 1);
    while (at < end && *at != '"') {
        const bool escape = *at == '\\' && at + 1 < end;
        if (escape && is_latex(at, end)) {
            hn_strbuf_add(out, "\\\\");
            at++;
            ++*backslashes;
            continue;
        }
        hn_strbuf_add_n(out, at, escape ? 2 : 1);
        at += escape ? 2 : 1;
    }
    if (at < end) {
        hn_strbuf_add_n(out, at++, 1);
    }
    return at;
}

void hn_submission_mend(hn_strbuf *out, const char *text, size_t n, int *commas, int *backslashes) {
    const char *at = text, *const end = text + n;
    *commas = *backslashes = 0;
    while (at < end) {
        if (*at == '"') {
            at = copy_string(out, at, end, backslashes);
            continue;
        }

        // a comma with nothing but white space before a closing bracket
        const char *next = at + 1;
        while (next < end && isspace((unsigned char)*next)) {
            next++;
        }
        const bool trailing = *at == ',' && next < end && (*next == ']' || *next == '}');
        *commas += trailing;
        hn_strbuf_add_n(out, trailing ? " " : at, 1); // what follows keeps its column
        at++;
    }
}
