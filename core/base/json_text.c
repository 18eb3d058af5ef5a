// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum {
    NUMBER_MAX = 400
}; // characters of one number; more is refused rather than rounded in silence

typedef struct scan {
    const char *text;
    size_t n, at;
    int depth, max_depth;
    hn_diag *diag;
    hn_status status;
} scan;

static int peek(const scan *s) {
    return s->at < s->n ? (unsigned char)s->text[s->at] : -1;
}

/// Line and column (in characters) of byte `at`.
static void locate(const scan *s, size_t at, int *line, int *column) {
    *line = 1;
    *column = 1;
    for (size_t i = 0; i < at && i < s->n; i++) {
        unsigned char c = (unsigned char)s->text[i];
        if (c == '\n') {
            (*line)++;
            *column = 1;
        } else if ((c & 0xC0) != 0x80) {
            (*column)++;
        }
    }
}

/// Names the character at the scan's place, for a message.
static void describe(const scan *s, char *out, size_t size) {
    int c = peek(s);
    if (c < 0) {
        snprintf(out, size, "the end of the text");
    } else if (c < 0x20 || c == 0x7F) {
        snprintf(out, size, "control character 0x%02X", (unsigned)c);
    } else if (c < 0x80) {
        snprintf(out, size, "'%c'", c);
    } else {
        snprintf(out, size, "byte 0x%02X", (unsigned)c);
    }
}

static bool fail(scan *s, hn_status status, const char *hint, const char *what) {
    int line, column;
    locate(s, s->at, &line, &column);
    s->status =
        hn_diag_set(s->diag, status, "", hint, "line %d, column %d: %s", line, column, what);
    return false;
}

/// "expected ..., found ..."
static int expected(scan *s, const char *hint, const char *what) {
    char found[40], message[160];
    describe(s, found, sizeof found);
    snprintf(message, sizeof message, "expected %s, found %s", what, found);
    return fail(s, HN_ERR_INPUT, hint, message);
}

static void skip_space(scan *s) {
    while (s->at < s->n && strchr(" \t\r\n", s->text[s->at]) && s->text[s->at] != '\0') {
        s->at++;
    }
}

static bool is_digit(int c) {
    return c >= '0' && c <= '9';
}

static int digits(scan *s, const char *where) {
    if (!is_digit(peek(s))) {
        return expected(s, NULL, where);
    }
    while (is_digit(peek(s))) {
        s->at++;
    }
    return 1;
}

static int number(scan *s) {
    size_t start = s->at;
    if (peek(s) == '-') {
        s->at++;
    }

    // whole part
    if (peek(s) == '0') {
        s->at++;
        if (is_digit(peek(s))) {
            return expected(s, "a number has no leading zeros",
                            "'.', an exponent or the end of the number");
        }
    } else if (!digits(s, "a digit")) {
        return 0;
    }

    // fraction and exponent
    if (peek(s) == '.') {
        s->at++;
        if (!digits(s, "a digit after the decimal point")) {
            return 0;
        }
    }
    if (peek(s) == 'e' || peek(s) == 'E') {
        s->at++;
        if (peek(s) == '+' || peek(s) == '-') {
            s->at++;
        }
        if (!digits(s, "a digit in the exponent")) {
            return 0;
        }
    }

    // the value must fit a double; strtod needs a zero at the end
    char copy[NUMBER_MAX + 1];
    size_t length = s->at - start;
    s->at = start;
    if (length > NUMBER_MAX) {
        return fail(s, HN_ERR_LIMIT, NULL, "a number of more than 400 characters");
    }
    memcpy(copy, s->text + start, length);
    copy[length] = '\0';
    if (!isfinite(strtod(copy, NULL))) {
        char message[120];
        snprintf(message, sizeof message, "%.40s is larger than any number here can be (1.8e308)",
                 copy);
        return fail(s, HN_ERR_INPUT, NULL, message);
    }
    s->at = start + length;
    return 1;
}

/// Length of the UTF-8 sequence at the scan's place, 0 if it is not valid (overlong, surrogate,
/// beyond U+10FFFF).
static size_t utf8_length(const scan *s) {
    const unsigned char *p = (const unsigned char *)s->text + s->at;
    size_t left = s->n - s->at, length = p[0] < 0x80   ? 1
                                         : p[0] < 0xC2 ? 0
                                         : p[0] < 0xE0 ? 2
                                         : p[0] < 0xF0 ? 3
                                         : p[0] < 0xF5 ? 4
                                                       : 0;
    if (length == 0 || length > left) {
        return 0;
    }
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    int bad = (p[0] == 0xE0 && p[1] < 0xA0) || (p[0] == 0xED && p[1] > 0x9F) ||
              (p[0] == 0xF0 && p[1] < 0x90) || (p[0] == 0xF4 && p[1] > 0x8F);
    return bad ? 0 : length;
}

/// Four hex digits after \u; -1 with a message if they are not there.
static int hex4(scan *s) {
    int value = 0;
    for (int i = 0; i < 4; i++, s->at++) {
        int c = peek(s);
        int digit = is_digit(c)            ? c - '0'
                    : c >= 'a' && c <= 'f' ? c - 'a' + 10
                    : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                           : -1;
        if (digit < 0) {
            expected(s, NULL, "four hexadecimal digits after \\u");
            return -1;
        }
        value = value * 16 + digit;
    }
    return value;
}

static int escape(scan *s) {
    s->at++;
    int c = peek(s);
    if (c < 0 || c == 0 || !strchr("\"\\/bfnrtu", c)) {
        return expected(s, "a backslash itself is written \\\\",
                        "one of \" \\ / b f n r t u after the backslash");
    }
    s->at++;
    if (c != 'u') {
        return 1;
    }

    // four hex digits: a character, or half a surrogate pair
    int value = hex4(s);
    if (value < 0) {
        return 0;
    }
    if (value == 0) {
        return fail(s, HN_ERR_INPUT, NULL, "the zero character \\u0000 is not allowed");
    }
    if (value >= 0xDC00 && value <= 0xDFFF) {
        return fail(s, HN_ERR_INPUT, NULL, "the second half of a surrogate pair stands alone");
    }

    // the other half must follow
    if (value >= 0xD800 && value <= 0xDBFF) {
        int pair = s->n - s->at >= 6 && s->text[s->at] == '\\' && s->text[s->at + 1] == 'u';
        s->at += pair ? 2 : 0;
        int low = pair ? hex4(s) : 0;
        if (low < 0) {
            return 0;
        }
        if (low < 0xDC00 || low > 0xDFFF) {
            return fail(s, HN_ERR_INPUT, NULL, "the first half of a surrogate pair stands alone");
        }
    }
    return 1;
}

static int string(scan *s) {
    size_t start = s->at++;
    for (;;) {
        int c = peek(s);

        // the end, or why there is none
        if (c == '"') {
            s->at++;
            return 1;
        }
        if (c < 0) {
            s->at = start;
            return fail(s, HN_ERR_INPUT, NULL, "the text that starts here has no closing '\"'");
        }
        if (c < 0x20) {
            return expected(s, "a line break inside a text is written \\n",
                            "a character or the closing '\"'");
        }

        // an escape, or one character of UTF-8
        if (c == '\\') {
            if (!escape(s)) {
                return 0;
            }
            continue;
        }
        size_t length = utf8_length(s);
        if (length == 0) {
            return expected(s, "save the file as UTF-8", "a character in UTF-8");
        }
        s->at += length;
    }
}

static int word(scan *s, const char *name) {
    size_t length = strlen(name);
    if (s->n - s->at < length || memcmp(s->text + s->at, name, length) != 0) {
        return expected(s, "bare words are only true, false and null; write texts in double quotes",
                        "a value");
    }
    s->at += length;
    return 1;
}

static int value(scan *s);

static int member(scan *s) {
    if (peek(s) != '"') {
        int c = peek(s);
        const char *hint = c == '}'   ? "remove the comma before the '}'"
                           : c == '/' ? "JSON has no comments"
                                      : "write names in double quotes";
        return expected(s, hint, "a name in double quotes");
    }
    if (!string(s)) {
        return 0;
    }
    skip_space(s);
    if (peek(s) != ':') {
        return expected(s, NULL, "':' after the name");
    }
    s->at++;
    return value(s);
}

/// An object or a list: what stands between its brackets.
static int container(scan *s, int close, int (*item)(scan *)) {
    if (++s->depth > s->max_depth) {
        char message[80];
        snprintf(message, sizeof message, "nested deeper than the %d levels allowed", s->max_depth);
        return fail(s, HN_ERR_LIMIT, NULL, message);
    }

    // the empty container
    s->at++;
    skip_space(s);
    if (peek(s) == close) {
        s->at++;
        s->depth--;
        return 1;
    }

    // items with commas between them
    for (;;) {
        if (!item(s)) {
            return 0;
        }
        skip_space(s);
        if (peek(s) == close) {
            s->at++;
            s->depth--;
            return 1;
        }
        if (peek(s) != ',') {
            return expected(s, NULL, close == '}' ? "',' or '}'" : "',' or ']'");
        }
        s->at++;
        skip_space(s);
    }
}

static int value(scan *s) {
    skip_space(s);
    int c = peek(s);

    // the first character decides; frequent slips get a hint of their own
    switch (c) {
    case '{':
        return container(s, '}', member);
    case '[':
        return container(s, ']', value);
    case '"':
        return string(s);
    case 't':
        return word(s, "true");
    case 'f':
        return word(s, "false");
    case 'n':
        return word(s, "null");
    case '\'':
        return expected(s, "write texts in double quotes", "a value");
    case '/':
        return expected(s, "JSON has no comments", "a value");
    case '.':
    case '+':
        return expected(s, "write 0.5, not .5 or +0.5", "a value");
    case ']':
    case '}':
        return expected(s, "remove the comma before it", "a value");
    case ',':
        return expected(s, "write the value that is missing before the comma", "a value");
    case 'N':
    case 'I':
        return expected(s, "NaN and Infinity are not numbers here", "a value");
    default:
        break;
    }

    if (c == '-' || is_digit(c)) {
        return number(s);
    }
    if (s->at == 0 && (c == 0xEF || c == 0xFE || c == 0xFF)) {
        return expected(s, "save the text as UTF-8 without a byte order mark", "a value");
    }
    return expected(s, c > 0x20 && c < 0x7F ? "write texts in double quotes" : NULL, "a value");
}

hn_status hn_json_text_locate(const char *text, size_t n, int max_depth, size_t *offset,
                              hn_diag *diag) {
    HN_ASSERT(text || n == 0);
    scan s = {.text = text, .n = n, .max_depth = max_depth, .diag = diag};
    skip_space(&s);
    if (s.at == s.n) {
        *offset = n;
        return hn_diag_set(diag, HN_ERR_INPUT, "", NULL,
                           n == 0 ? "the text is empty" : "the text holds nothing but white space");
    }
    if (value(&s)) {
        skip_space(&s);
        if (s.at == s.n) {
            return HN_OK;
        }
        expected(&s, NULL, "nothing after the value");
    }
    *offset = s.at;
    return s.status;
}

hn_status hn_json_text_check(const char *text, size_t n, int max_depth, hn_diag *diag) {
    size_t offset;
    return hn_json_text_locate(text, n, max_depth, &offset, diag);
}
