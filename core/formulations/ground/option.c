// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/option.h"

#include "base/suggest.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_VALUE = 48 };

static const char *unit_text(const hn_option *option) {
    return option->unit && option->unit[0] ? option->unit : NULL;
}

hn_status hn_option_check(const hn_option *option, double value, hn_diag *diag) {
    const char *unit = unit_text(option);
    if (!isfinite(value)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s must be a finite number",
                           option->key);
    }
    if (value <= 0 && option->min > 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "%s must be greater than 0%s%s; it is %g", option->key, unit ? " " : "",
                           unit ? unit : "", value);
    }
    if (value < option->min || value > option->max) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s = %g is out of range: %g to %g%s%s",
                           option->key, value, option->min, option->max, unit ? " " : "",
                           unit ? unit : "");
    }
    if (option->choices && value != floor(value)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s takes a name, not %g", option->key,
                           value);
    }
    return HN_OK;
}

static hn_status find_choice(const hn_option *option, const char *word, double *value,
                             hn_diag *diag) {
    for (int i = 0; i < option->n_choices; i++) {
        if (strcmp(option->choices[i], word) == 0) {
            *value = i;
            return HN_OK;
        }
    }
    char list[160] = "", hint[HN_DIAG_HINT];
    size_t n = 0;
    for (int i = 0; i < option->n_choices && n < sizeof list; i++) {
        const int wrote =
            snprintf(list + n, sizeof list - n, "%s%s", i ? ", " : "", option->choices[i]);
        n += wrote > 0 ? (size_t)wrote : 0;
    }
    hn_suggest(hint, word, option->choices, option->n_choices, NULL);
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "%s = '%s' is not one of: %s", option->key,
                       word, list);
}

// 1 when the unit that follows a number is known; *parts of it make the option's own unit
static bool read_unit(const hn_option *option, const char *unit, double *parts) {
    *parts = 1;
    if (unit[0] == '\0' || (option->unit && strcmp(unit, option->unit) == 0)) {
        return true;
    }
    const int is_time = option->unit && strcmp(option->unit, "s") == 0;
    if (is_time && strcmp(unit, "ms") == 0) {
        *parts = 1e3;
        return true;
    }
    if (is_time && strcmp(unit, "us") == 0) {
        *parts = 1e6;
        return true;
    }
    return false;
}

// Length of the decimal number at the start of s (no hexadecimal, no nan, no inf), 0 if there is
// none.
static size_t number_length(const char *s) {
    size_t i = s[0] == '+' || s[0] == '-';

    // digits with at most one point
    size_t digits = 0;
    for (; isdigit((unsigned char)s[i]); i++) {
        digits++;
    }
    if (s[i] == '.') {
        for (i++; isdigit((unsigned char)s[i]); i++) {
            digits++;
        }
    }
    if (digits == 0) {
        return 0;
    }

    // exponent, where digits follow it
    if (s[i] == 'e' || s[i] == 'E') {
        size_t j = i + 1;
        j += s[j] == '+' || s[j] == '-';
        if (isdigit((unsigned char)s[j])) {
            while (isdigit((unsigned char)s[j])) {
                j++;
            }
            i = j;
        }
    }
    return i;
}

hn_status hn_option_parse(const hn_option *option, const char *text, double *value, hn_diag *diag) {
    char word[MAX_VALUE];
    size_t n = 0;

    // the word without blanks, a decimal comma read as a point
    while (isspace((unsigned char)*text)) {
        text++;
    }
    for (; text[n] && n + 1 < sizeof word; n++) {
        word[n] = text[n] == ',' ? '.' : text[n]; // a decimal comma
    }
    const int too_long = text[n] != '\0';
    while (n > 0 && isspace((unsigned char)word[n - 1])) {
        n--;
    }
    word[n] = '\0';

    // a named value
    if (option->choices && !too_long) {
        return find_choice(option, word, value, diag);
    }

    // a number with its unit
    const size_t length = too_long ? 0 : number_length(word);
    if (length == 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           word[0] ? "%s needs a number, found '%s'" : "%s needs a number%s",
                           option->key, word);
    }
    const char *unit = word + length;
    while (isspace((unsigned char)*unit)) {
        unit++;
    }
    double parts = 1;
    if (!read_unit(option, unit, &parts)) {
        const char *own = unit_text(option);
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s: '%s' is not understood, %s%s",
                           option->key, unit, own ? "its unit is " : "it has no unit",
                           own ? own : "");
    }

    word[length] = '\0';
    // dividing by a power of ten keeps "20 ms" equal to 0.02 to the last bit
    const double number = strtod(word, NULL) / parts;
    HN_TRY(hn_option_check(option, number, diag));
    *value = number;
    return HN_OK;
}
