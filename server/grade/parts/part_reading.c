// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a plot. The program runs a method and plots a curve of its motion (motion_curve.h); the
// student reads a value or a time.
//
//     "read": "largest"                    or another row of the table of readings
//     "number": "2*t1"                     the time or the level, for a reading that needs one
//     "unit": "mm"                         optional; of the answer: else that of the axis
//     "second": "projection@dop853"        the same curve by another method, for the proof
//     "tolerance": {"of_range": 0.03}      share of the span of the axis that is read
#include "grade/parts/blank.h"
#include "grade/parts/curve_figure.h"
#include "grade/parts/part_list.h"
#include "grade/parts/value_entry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 78 };
static const double COARSE = 2;      // times what is allowed: a coarse reading, not a slip
static const double OF_SIZE = 0.5;   // of a slip's own value: beyond, it is another number
static const double OF_RANGE = 0.03; // a twentieth of an interval between labels is 1 % of the axis

/// The curve, what is asked, and the answer.
typedef struct sheet {
    const hn_part *p;
    hn_motion_curve curve;
    const hn_curve_reading *reading;
    double number, answer, span, allowed; ///< in the units of the axes
    char unit[24];                        ///< of the answer, as the student is asked for it
    double factor;                        ///< of the axis over that of the answer
} sheet;

static double tolerance_of(const hn_part *p) {
    return hn_part_number(cJSON_GetObjectItemCaseSensitive(p->node, "tolerance"), "of_range",
                          OF_RANGE);
}

/// Length of the axis on which a reading is made.
static double span_of(const sheet *s, const hn_curve_reading *reading) {
    double low, high;
    hn_curve_axis(&s->curve, &low, &high);
    return reading->is_time ? s->curve.t_end : high - low;
}

/// The unit of the answer; it must measure what the axis shows.
static hn_status choose_unit(sheet *s, hn_diag *diag) {
    const char *axis = s->reading->is_time ? "s" : s->curve.unit;
    const char *asked = hn_part_text(s->p->node, "unit");
    hn_unit a = {.factor = 1}, b = {.factor = 1};
    snprintf(s->unit, sizeof s->unit, "%s", asked[0] ? asked : axis);
    if (!hn_unit_parse(axis, &a) || !hn_unit_parse(s->unit, &b) || !hn_unit_fits(&a, &b)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/unit", NULL,
                           "part %s: the axis is in %s, not in %s", s->p->id, axis, s->unit);
    }
    s->factor = a.factor / b.factor;
    return HN_OK;
}

static hn_status open_sheet(sheet *s, const hn_part *p, const char *method, hn_diag *diag) {
    s->p = p;
    s->reading = hn_curve_reading_find(hn_part_text(p->node, "read"), diag);
    if (!s->reading) {
        return HN_ERR_INPUT;
    }
    if (s->reading->needs_number) {
        HN_TRY(hn_draw_value(p->draw, hn_part_text(p->node, "number"), &s->number, diag));
    }
    HN_TRY(hn_motion_curve_make(&s->curve, p, method, diag));
    s->answer = s->reading->read(&s->curve, s->number);
    s->span = span_of(s, s->reading);
    s->allowed = tolerance_of(p) * s->span;
    if (!isfinite(s->answer)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/read", NULL,
                           "part %s: the curve does not show %s", p->id, s->reading->says);
    }
    return choose_unit(s, diag);
}

/// The sheet of a part, owned; NULL with the status.
static sheet *make_sheet(const hn_part *p, hn_status *status, hn_diag *diag) {
    sheet *s = calloc(1, sizeof *s);
    *status = s ? open_sheet(s, p, hn_part_text(p->node, "method"), diag) : HN_ERR_MEMORY;
    if (*status != HN_OK) {
        free(s);
        return NULL;
    }
    return s;
}

// ---- mistakes ----

/// A slip of reading that can be computed from the curve.
typedef struct slip {
    char id[24];
    double value, near; ///< in units of the axis; how near a value is taken for it
    double share;
    char says[HN_PART_TEXT];
} slip;

/// The i-th slip; false after the last. One without a value has NaN.
static bool get_slip(const sheet *s, int i, slip *out) {
    static const double POWERS[] = {10, 0.1, 1000, 1e-3, 1e6, 1e-6};
    enum { N_POWERS = sizeof POWERS / sizeof *POWERS };
    *out = (slip){.value = (double)NAN};
    if (i < N_POWERS) {
        out->value = s->answer * POWERS[i];
        out->near = s->allowed * POWERS[i];
        out->share = 0.5;
        snprintf(out->id, sizeof out->id, "power-of-ten");
        snprintf(out->says, sizeof out->says,
                 "this is %g times what the plot shows: look at the numbers and at the unit beside "
                 "the axis",
                 POWERS[i]);
        return true;
    }
    if (i == N_POWERS) {
        out->value = -s->answer;
        out->near = s->allowed;
        out->share = 0.5;
        snprintf(out->id, sizeof out->id, "sign");
        snprintf(out->says, sizeof out->says, "the sign is the other one");
        return true;
    }

    // another place of the same plot
    const hn_curve_reading *other = hn_curve_reading_at(i - N_POWERS - 1);
    if (!other) {
        return false;
    }
    if (other != s->reading && !(other->needs_number && !s->reading->needs_number)) {
        // what is read on the other axis is typed as it stands there
        const double typed = other->is_time == s->reading->is_time ? 1 : s->factor;
        out->value = other->read(&s->curve, s->number) / typed;
        out->near = tolerance_of(s->p) * span_of(s, other) / typed;
        snprintf(out->id, sizeof out->id, "%s",
                 other->is_time == s->reading->is_time ? "other-place" : "other-axis");
        snprintf(out->says, sizeof out->says, "this is %s; %s is asked for", other->says,
                 s->reading->says);
    }
    return true;
}

/// Returns whether a value is that of a slip: as near as a reading is, and of its size. A number
/// beside 0 is no reading of a curve that is 0 there: it is another mistake, as a wrong unit.
static bool is_slip(const slip *x, double value) {
    const double apart = fabs(value - x->value);
    return apart <= x->near && (value == 0 || apart <= OF_SIZE * fabs(x->value));
}

/// The slip that comes nearest to a value; one on the axis that is asked for comes before one on
/// the other. False: none gives the value.
static bool find_slip(const sheet *s, double value, slip *out) {
    slip x;
    bool found = false;
    for (int i = 0; get_slip(s, i, &x); i++) {
        const bool other_axis = strcmp(x.id, "other-axis") == 0;
        const bool was_other = found && strcmp(out->id, "other-axis") == 0;
        const bool nearer =
            found && other_axis == was_other && fabs(value - x.value) < fabs(value - out->value);
        if (is_slip(&x, value) && (!found || (was_other && !other_axis) || nearer)) {
            *out = x;
            found = true;
        }
    }
    return found;
}

// ---- the functions of the kind ----

/// Returns the fewest digits, two at least, with which two numbers are printed differently.
static int count_telling_digits(double a, double b) {
    char one[32], other[32];
    int digits = 1;
    do {
        digits++;
        snprintf(one, sizeof one, "%.*g", digits, a);
        snprintf(other, sizeof other, "%.*g", digits, b);
    } while (strcmp(one, other) == 0 && digits < 15);
    return digits;
}

static void judge(const sheet *s, double value, hn_part_result *r) {
    slip found;
    const double apart = fabs(value - s->answer);
    if (apart <= s->allowed) {
        hn_part_right(r);
    } else if (apart <= COARSE * s->allowed) {
        const int digits = count_telling_digits(apart * s->factor, s->allowed * s->factor);
        hn_part_wrong(r, "inexact", 0.5,
                      "near, but read too coarsely: %.*g %s away, %.*g %s are allowed", digits,
                      apart * s->factor, s->unit, digits, s->allowed * s->factor, s->unit);
    } else if (find_slip(s, value, &found)) {
        hn_part_wrong(r,
                      !strcmp(found.id, "sign")           ? "sign"
                      : !strcmp(found.id, "power-of-ten") ? "power-of-ten"
                      : !strcmp(found.id, "other-axis")   ? "other-axis"
                                                          : "other-place",
                      found.share, "%s", found.says);
    } else {
        hn_part_wrong(r, "other", 0,
                      "the plot does not show this: follow the curve to %s, then go to the axis",
                      s->reading->says);
    }
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    hn_status status;
    hn_ex e;
    double x[HN_DRAW_STATES];
    sheet *s = make_sheet(p, &status, diag);
    HN_TRY(status);
    hn_value_sheet reader = {.p = p, .draw = p->draw, .diag = diag};
    char expected[80];
    snprintf(expected, sizeof expected, "%.4g %s", s->answer * s->factor, s->unit);

    // a number, with or without its unit
    hn_unit_parse(s->unit, &reader.unit);
    if (hn_part_begin(r, n, given, expected) && hn_value_entry_read(&reader, given, x, &e, r)) {
        judge(s, x[0] / s->factor, r);
    }
    free(s);
    return HN_OK;
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    hn_status status;
    sheet *s = make_sheet(p, &status, diag);
    cJSON *out = s ? cJSON_CreateNumber(s->answer * s->factor) : NULL;
    free(s);
    return out;
}

/// Every slip whose value is not also right, or that of a slip before it.
static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    static const char *const IDS[] = {"power-of-ten", "sign", "other-place", "other-axis"};
    hn_status status;
    slip asked, found;
    sheet *s = make_sheet(p, &status, diag);
    cJSON *out = NULL;
    *id = "";
    if (s && get_slip(s, i, &asked)) {
        const bool clear = isfinite(asked.value) &&
                           fabs(asked.value - s->answer) > COARSE * s->allowed &&
                           find_slip(s, asked.value, &found);
        for (int k = 0; k < 4 && clear; k++) {
            *id = strcmp(IDS[k], found.id) == 0 ? IDS[k] : *id;
        }
        out = cJSON_CreateNumber(isfinite(asked.value) ? asked.value * s->factor : 0);
    }
    free(s);
    return out;
}

/// Another method shows the same curve to a third of what is allowed.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    hn_status status;
    const char *method = hn_part_text(p->node, "second");
    sheet *s = make_sheet(p, &status, diag);
    sheet *other = calloc(1, sizeof *other);
    if (s && !other) {
        status = HN_ERR_MEMORY;
    } else if (s) {
        status = open_sheet(other, p, method, diag);
        if (status == HN_OK && !(fabs(other->answer - s->answer) <= s->allowed / 3)) {
            status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                                 "part %s: %.6g, and by the second method %.6g", p->id, s->answer,
                                 other->answer);
        }
    }
    free(other);
    free(s);
    return status;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    hn_status status;
    hn_diag diag = {0};
    sheet *s = make_sheet(p, &status, &diag);
    if (s) {
        hn_strbuf_printf(b, "a number in %s, read from the plot; right to %.2g %s", s->unit,
                         s->allowed * s->factor, s->unit);
    }
    b->failed |= status == HN_ERR_MEMORY;
    free(s);
}

static void figure(hn_strbuf *b, const hn_part *p, hn_figure_form form) {
    hn_status status;
    hn_diag diag = {0};
    char title[160];
    sheet *s = make_sheet(p, &status, &diag);
    snprintf(title, sizeof title, "%.60s [%s] over time, %.60s", hn_part_text(p->node, "curve"),
             s ? s->curve.unit : "", hn_part_text(p->node, "method"));
    if (s && form == HN_FIGURE_FILE) {
        hn_curve_picture(b, &s->curve, title);
    } else if (s && form == HN_FIGURE_PAGE) {
        hn_curve_svg(b, &s->curve, title);
    } else if (s) {
        hn_curve_text(b, &s->curve, title, COLUMNS);
    }
    b->failed |= status == HN_ERR_MEMORY;
    free(s);
}

const hn_part_kind hn_part_reading = {
    .name = "reading",
    .fields = "scene set method second time curve read number unit tolerance",
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_number,
    .right = right,
    .fault = fault,
    .prove = prove,
    .figure = figure,
};
