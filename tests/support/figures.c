// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct hn_figures {
    void (*show)(void *user, const hn_figure_result *result);
    void *user;
};

/// A printed number taken apart.
typedef struct number {
    char bound; ///< '<', '>' or 0
    double value;
    double unit; ///< of the last printed digit
    int digits;  ///< significant ones
} number;

static int read_number(const char *text, number *out) {
    const char *p = text;
    char *end = NULL;
    int decimals = 0, seen_point = 0, exponent = 0;
    *out = (number){0};
    if (*p == '<' || *p == '>') {
        out->bound = *p++;
    }
    out->value = strtod(p, &end);
    if (end == p || *end) {
        return 0;
    }
    for (; p < end; p++) {
        if (*p == 'e' || *p == 'E') {
            exponent = atoi(p + 1);
            break;
        }
        seen_point |= *p == '.';
        if (*p >= '0' && *p <= '9') {
            decimals += seen_point;
            out->digits += out->digits > 0 || *p != '0';
        }
    }
    out->unit = pow(10, exponent - decimals);
    return 1;
}

static int is_met(const number *n, double found, double units, double factor) {
    if (!isfinite(found)) {
        return 0;
    }
    if (n->bound) {
        return n->bound == '<' ? found < n->value : found > n->value;
    }
    // a single digit says little enough: it has to be ours when rounded
    const double usual = n->digits > 1 ? 1 : 0.5;
    const double off = fabs(found - n->value), allowed = (units > 0 ? units : usual) * n->unit;
    if (off <= allowed * (1 + 1e-9)) {
        return 1;
    }
    return factor > 0 && n->value != 0 && found / n->value <= factor &&
           found / n->value >= 1 / factor;
}

/// Significant digits of the printed figure that are met: all when ours rounds to the same.
static int digits_met(const number *n, double found) {
    const double off = fabs(found - n->value);
    int digits = n->digits;
    for (double unit = n->unit; digits > 0 && off > 0.5 * unit * (1 + 1e-9); unit *= 10) {
        digits--;
    }
    return digits;
}

static void judge_number(const hn_figure *figure, const number *n, double found,
                         hn_figure_result *r) {
    const char *note = figure->note ? figure->note : "";
    if (figure->instead) {
        number ours;
        r->good = read_number(figure->instead, &ours) &&
                  is_met(&ours, found, figure->units, figure->factor);
        snprintf(r->verdict, sizeof r->verdict, "%s%s", r->good ? "differs: " : "OUT: ", note);
        return;
    }
    r->good = is_met(n, found, figure->units, figure->factor);
    const int digits = n->bound || !isfinite(found) ? 0 : digits_met(n, found);
    const char *const colon = *note ? ": " : "";
    if (!r->good) {
        snprintf(r->verdict, sizeof r->verdict, "OUT%s%s", colon, note);
    } else if (n->bound || digits == n->digits) {
        snprintf(r->verdict, sizeof r->verdict, "as printed%s%s", colon, note);
    } else if (n->digits > 1 && fabs(found - n->value) <= n->unit * (1 + 1e-9)) {
        snprintf(r->verdict, sizeof r->verdict, "to the last digit%s%s", colon, note);
    } else if (digits > 0) {
        snprintf(r->verdict, sizeof r->verdict, "%d of %d digits%s%s", digits, n->digits, colon,
                 note);
    } else {
        snprintf(r->verdict, sizeof r->verdict, "%.2f times the printed%s%s", found / n->value,
                 colon, note);
    }
}

/// In the manner of the printed one, with a digit more up to six, so that agreement can be judged.
static void show_number(const char *printed, const number *n, double found, char *out,
                        size_t size) {
    const int digits = n->digits > 6 ? n->digits : n->digits + 1;
    if (n->bound) {
        snprintf(out, size, "%.4g", found);
    } else if (strchr(printed, 'e')) {
        snprintf(out, size, "%.*e", digits - 1, found);
    } else {
        snprintf(out, size, "%.*g", digits, found);
    }
}

void hn_figure_add(hn_figures *f, const hn_figure *figure, double found) {
    hn_figure_result r = {.good = 0};
    number n;
    snprintf(r.what, sizeof r.what, "%s", figure->what);
    snprintf(r.how, sizeof r.how, "%s", figure->how ? figure->how : "");
    snprintf(r.printed, sizeof r.printed, "%s", figure->printed);
    if (!read_number(figure->printed, &n)) {
        // printed in words, found as a number: has to be what is said instead
        n = (number){.digits = 2};
    }
    show_number(figure->printed, &n, found, r.found, sizeof r.found);
    judge_number(figure, &n, found, &r);
    f->show(f->user, &r);
}

void hn_figure_put(hn_figures *f, const char *what, const char *how, const char *printed,
                   double found) {
    hn_figure_add(f, &(hn_figure){.what = what, .how = how, .printed = printed}, found);
}

void hn_figure_put_words(hn_figures *f, const char *what, const char *how, const char *printed,
                         const char *found) {
    hn_figure_result r = {.good = strcmp(printed, found) == 0};
    snprintf(r.what, sizeof r.what, "%s", what);
    snprintf(r.how, sizeof r.how, "%s", how);
    snprintf(r.printed, sizeof r.printed, "%s", printed);
    snprintf(r.found, sizeof r.found, "%s", found);
    snprintf(r.verdict, sizeof r.verdict, "%s", r.good ? "as printed" : "OUT");
    f->show(f->user, &r);
}

void hn_figure_topic_run(const hn_figure_topic *topic,
                         void (*show)(void *user, const hn_figure_result *result), void *user) {
    hn_figures f = {show, user};
    topic->measure(&f);
}
