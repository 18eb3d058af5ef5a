#include "http/json_scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct scan {
    const unsigned char *text;
    size_t n, at;
    int depth;
    hn_json_fault *fault;
} scan;

static int scan_value(scan *s);

static int fail(scan *s, size_t offset, const char *what) {
    s->fault->offset = offset;
    s->fault->what = what;
    return 0;
}

/// The next byte, or -1 at the end.
static int peek(const scan *s) {
    return s->at < s->n ? s->text[s->at] : -1;
}

static void skip_space(scan *s) {
    while (s->at < s->n && strchr(" \t\r\n", s->text[s->at]) && s->text[s->at]) {
        s->at++;
    }
}

/// Length of the UTF-8 sequence at the present byte, 0 if there is none. Table 3-7 of the Unicode standard.
static size_t utf8_length(const scan *s) {
    static const struct {
        unsigned char lo, hi, second_lo, second_hi, more;
    } rows[] = {{0xc2, 0xdf, 0x80, 0xbf, 1}, {0xe0, 0xe0, 0xa0, 0xbf, 2},
                {0xe1, 0xec, 0x80, 0xbf, 2}, {0xed, 0xed, 0x80, 0x9f, 2},
                {0xee, 0xef, 0x80, 0xbf, 2}, {0xf0, 0xf0, 0x90, 0xbf, 3},
                {0xf1, 0xf3, 0x80, 0xbf, 3}, {0xf4, 0xf4, 0x80, 0x8f, 3}};
    const unsigned char *p = s->text + s->at;
    size_t left = s->n - s->at;
    if (p[0] < 0x80) {
        return 1;
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (p[0] < rows[i].lo || p[0] > rows[i].hi) {
            continue;
        }
        if (left <= rows[i].more || p[1] < rows[i].second_lo || p[1] > rows[i].second_hi) {
            return 0;
        }
        for (size_t k = 2; k <= rows[i].more; k++) {
            if ((p[k] & 0xc0) != 0x80) {
                return 0;
            }
        }
        return rows[i].more + 1u;
    }
    return 0;
}

static int scan_escape(scan *s) {
    size_t start = s->at++;
    int c = peek(s);
    if (c == 'u') {
        for (int k = 1; k <= 4; k++) {
            int digit = s->at + (size_t)k < s->n ? s->text[s->at + (size_t)k] : -1;
            if (digit < 0 || !strchr("0123456789abcdefABCDEF", digit) || !digit) {
                return fail(s, start, "\\u needs four hexadecimal digits");
            }
        }
        if (memcmp(s->text + s->at + 1, "0000", 4) == 0) {
            return fail(s, start, "the character U+0000 is not taken in a string");
        }
        s->at += 5;
        return 1;
    }
    if (c <= 0 || !strchr("\"\\/bfnrt", c)) {
        return fail(s, start, "unknown escape in a string");
    }
    s->at++;
    return 1;
}

static int scan_string(scan *s) {
    size_t start = s->at++;
    while (peek(s) != '"') {
        int c = peek(s);
        if (c < 0) {
            return fail(s, start, "a string that begins here never ends");
        }
        if (c < 0x20) {
            return fail(s, s->at, "a control character in a string must be escaped");
        }
        if (c == '\\') {
            if (!scan_escape(s)) {
                return 0;
            }
            continue;
        }
        size_t length = utf8_length(s);
        if (!length) {
            return fail(s, s->at, "the bytes here are not UTF-8");
        }
        s->at += length;
    }
    s->at++;
    return 1;
}

static int is_digit(int c) {
    return c >= '0' && c <= '9';
}

static int scan_digits(scan *s) {
    if (!is_digit(peek(s))) {
        return fail(s, s->at, "a digit is missing in a number");
    }
    while (is_digit(peek(s))) {
        s->at++;
    }
    return 1;
}

/// strtod on a bounded copy: the text need not be terminated.
static int is_finite_number(const scan *s, size_t start) {
    char copy[64];
    size_t n = s->at - start;
    if (n >= sizeof copy) {
        char *longer = malloc(n + 1);
        if (!longer) {
            return 0;
        }
        memcpy(longer, s->text + start, n);
        longer[n] = 0;
        int finite = isfinite(strtod(longer, NULL));
        free(longer);
        return finite;
    }
    memcpy(copy, s->text + start, n);
    copy[n] = 0;
    return isfinite(strtod(copy, NULL));
}

static int scan_number(scan *s) {
    size_t start = s->at;
    if (peek(s) == '-') {
        s->at++;
    }
    if (peek(s) == '0') {
        s->at++;
        if (is_digit(peek(s))) {
            return fail(s, start, "a number must not begin with 0");
        }
    } else if (!scan_digits(s)) {
        return 0;
    }
    if (peek(s) == '.') {
        s->at++;
        if (!scan_digits(s)) {
            return 0;
        }
    }
    if (peek(s) == 'e' || peek(s) == 'E') {
        s->at++;
        if (peek(s) == '+' || peek(s) == '-') {
            s->at++;
        }
        if (!scan_digits(s)) {
            return 0;
        }
    }
    return is_finite_number(s, start) ? 1 : fail(s, start, "the number is too large for a double");
}

static int scan_array(scan *s) {
    s->at++;
    skip_space(s);
    if (peek(s) == ']') {
        s->at++;
        return 1;
    }
    for (;;) {
        if (!scan_value(s)) {
            return 0;
        }
        int c = peek(s);
        if (c != ',' && c != ']') {
            return fail(s, s->at,
                        c < 0 ? "the text ends inside an array" : "',' or ']' is expected");
        }
        s->at++;
        if (c == ']') {
            return 1;
        }
    }
}

static int scan_object(scan *s) {
    s->at++;
    skip_space(s);
    if (peek(s) == '}') {
        s->at++;
        return 1;
    }
    for (;;) {
        skip_space(s);
        if (peek(s) != '"') {
            return fail(s, s->at,
                        peek(s) < 0 ? "the text ends inside an object"
                                    : "a name in double quotes is expected");
        }
        if (!scan_string(s)) {
            return 0;
        }
        skip_space(s);
        if (peek(s) != ':') {
            return fail(s, s->at, "':' is expected after a name");
        }
        s->at++;
        if (!scan_value(s)) {
            return 0;
        }
        int c = peek(s);
        if (c != ',' && c != '}') {
            return fail(s, s->at,
                        c < 0 ? "the text ends inside an object" : "',' or '}' is expected");
        }
        s->at++;
        if (c == '}') {
            return 1;
        }
    }
}

static int scan_word(scan *s) {
    static const char *const words[] = {"true", "false", "null"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i]);
        if (s->n - s->at >= length && memcmp(s->text + s->at, words[i], length) == 0) {
            s->at += length;
            return 1;
        }
    }
    return fail(s, s->at,
                peek(s) < 0 ? "the text ends where a value is expected"
                            : "a value is expected (JSON has no NaN, Infinity or bare words)");
}

/// One value with the space around it.
static int scan_value(scan *s) {
    if (++s->depth > HN_JSON_MAX_DEPTH) {
        return fail(s, s->at, "values are nested more than 64 deep");
    }
    skip_space(s);
    int c = peek(s);
    int ok = c == '{'                  ? scan_object(s)
             : c == '['                ? scan_array(s)
             : c == '"'                ? scan_string(s)
             : c == '-' || is_digit(c) ? scan_number(s)
                                       : scan_word(s);
    skip_space(s);
    s->depth--;
    return ok;
}

int hn_json_scan(const char *text, size_t n, hn_json_fault *fault) {
    scan s = {.text = (const unsigned char *)text, .n = n, .fault = fault};
    if (!scan_value(&s)) {
        return 0;
    }
    return s.at == n ? 1 : fail(&s, s.at, "something follows the end of the value");
}
