// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/verdict/verdict.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A gap whose largest value of the second half of the motion is so many times that of the first
/// half grows; a gap that follows t or t^2 does.
static const double GROWTH = 1.5;
/// A gap that has fallen below this share of its largest value does not grow any more.
static const double FALLEN = 0.9;
/// A last quarter of the motion whose largest gap is more than so many times that of the third one
/// is a jump, unless the quarter before rose by the root of that: a gap that follows t^8 rises by
/// 10, and one that grows exponentially rises by the same factor each time.
static const double JUMP = 10;
static const double OPEN = 1e-2;      // of the scene's length: a gap that is the first thing to say
static const double VISIBLE = 1e-3;   // of the scene's length: a gap or distance that can be seen
static const double WRONG = 1e-2;     // of the scene's length or energy: one digit is right at most
static const double CLOSED = 1e-12;   // of the scene's length: rounding
static const double ROUNDING = 1e-13; // [m] some hundred roundings of coordinates of a metre or so
static const double MOST_DIGITS = 15;

// ---- sizes ----

/// The largest magnitude of the frames from..to; NaN where none has one.
static double worst(const double *column, int from, int to) {
    double most = (double)NAN;
    for (int k = from; k <= to; k++) {
        const double size = fabs(column[k]);
        most = isnan(size) || size <= most ? most : size;
    }
    return most;
}

/// Returns whether the gap is large by one rise at the end of the motion: stabilised methods fall
/// from there.
static bool has_jumped(const hn_motion_history *h) {
    const int half = h->shown / 2, later = h->shown * 3 / 4;
    const double second = worst(h->gap, h->shown / 4, half), third = worst(h->gap, half, later);
    const double rise = worst(h->gap, later, h->shown) / third, before = third / second;
    return rise > JUMP && !(rise <= before * before);
}

typedef enum trend { CLOSED_TREND, STARTED, GROWING, SHRINKING, HELD } trend;

static trend trend_of(const hn_motion_history *h) {
    const int half = h->shown / 2;
    const double late = worst(h->gap, half, h->shown);
    if (!(late > ROUNDING)) {
        return CLOSED_TREND;
    }
    if (h->shown < HN_MOTION_EARLIEST) {
        return STARTED;
    }
    const double early = worst(h->gap, 0, half);
    const bool rises = late > GROWTH * early && fabs(h->gap[h->shown]) >= FALLEN * late;
    const bool grows = rises && !has_jumped(h);
    return grows ? GROWING : late < early / GROWTH ? SHRINKING : HELD;
}

typedef struct sizes {
    double gap_now, gap, off, energy; ///< [m], [m], [m], [J]
    double length, energy_scale, digits;
    bool loops, grows, asked;
} sizes;

static sizes measure(const hn_motion_history *h, trend is) {
    return (sizes){.gap_now = h->gap[h->shown],
                   .gap = worst(h->gap, 0, h->shown),
                   .off = worst(h->off, 0, h->shown),
                   .energy = worst(h->energy, 0, h->shown),
                   .length = h->length > 0 ? h->length : 1,
                   .energy_scale = h->energy_scale,
                   .digits = h->digits,
                   .loops = h->loops,
                   .grows = is == GROWING,
                   .asked = h->asked};
}

// ---- words ----

/// "6.0×10⁻¹³": the mantissa as printf writes it, the exponent raised.
static void power_of_ten(double value, int digits, char out[HN_SI_TEXT]) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char text[40];
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    char *exponent = strchr(text, 'e');
    *exponent++ = '\0';
    size_t used = (size_t)snprintf(out, HN_SI_TEXT, "%s×10%s", text, *exponent == '-' ? "⁻" : "");
    for (exponent += 1 + strspn(exponent + 1, "0"); *exponent; exponent++) {
        used += (size_t)snprintf(out + used, HN_SI_TEXT - used, "%s", raised[*exponent - '0']);
    }
}

static void quantity(double value, const char *unit, int digits, char out[HN_SI_TEXT]) {
    if (value != 0 && fabs(value) < HN_SI_SMALLEST) {
        power_of_ten(value, digits, out);
        const size_t used = strlen(out);
        snprintf(out + used, HN_SI_TEXT - used, " %s", unit);
    } else {
        hn_si_format(hn_round_digits(value, digits), unit, digits, out);
    }
}

static void put(hn_motion_verdict *v, hn_tone tone, const char *first, const char *joint,
                const char *second) {
    v->tone = tone;
    snprintf(v->text, sizeof v->text, "%.70s%.6s%.70s", first, first[0] && second[0] ? joint : "",
             second);
}

/// "closed", "closed to 4.1 µm", "open by 2.1 mm", or nothing for a mechanism without loops.
static void closed_words(const sizes *s, char *out, size_t size) {
    char gap[HN_SI_TEXT];
    if (!s->loops) {
        out[0] = '\0';
    } else if (s->gap > VISIBLE * s->length) {
        quantity(s->gap, "m", 2, gap);
        snprintf(out, size, "open by %s", gap);
    } else if (s->gap <= CLOSED * s->length) {
        snprintf(out, size, "closed");
    } else {
        // as the gap of now is written beside it: near rounding a second digit means nothing
        quantity(s->gap, "m", s->gap < HN_SI_SMALLEST ? 1 : 2, gap);
        snprintf(out, size, "closed to %s", gap);
    }
}

/// A closed loop does not make a motion right, and an open one is one fault more.
static void judge_wrong(hn_motion_verdict *v, const sizes *s, double value, const char *unit,
                        const char *what) {
    char first[64], number[HN_SI_TEXT], second[96];
    closed_words(s, first, sizeof first);
    quantity(value, unit, 2, number);
    snprintf(second, sizeof second, "%s %s", number, what);
    put(v, HN_TONE_BAD, first, s->gap > VISIBLE * s->length ? " and " : ", but ", second);
}

/// The digits that are right, by the worse of motion and energy; no more than the reference has.
/// *more: the reference bounds them, and the motion may have more.
static double right_digits(const sizes *s, bool *more) {
    const double energy = s->energy_scale > 0 ? s->energy / s->energy_scale : 0;
    const double share = fmax(fmax(s->off / s->length, energy), pow(10, -MOST_DIGITS));
    const double sure = floor(fmin(MOST_DIGITS, s->digits)), own = floor(-log10(share));
    *more = sure < own;
    return fmin(sure, own);
}

static void judge_right(hn_motion_verdict *v, const sizes *s) {
    char drift[64] = "", first[64], number[HN_SI_TEXT];
    const bool drifts = s->loops && s->grows;
    const hn_tone tone = drifts ? HN_TONE_WARN : HN_TONE_CALM;
    if (drifts) {
        quantity(s->gap, "m", 2, number);
        snprintf(drift, sizeof drift, "gap %s and growing", number);
    }

    // without a reference a closed loop is no praise
    if (isnan(s->off)) {
        closed_words(s, first, sizeof first);
        put(v, tone, drifts ? drift : first, ", ", s->asked ? "not compared yet" : "error unknown");
        return;
    }
    bool more;
    const double digits = right_digits(s, &more);
    snprintf(first, sizeof first, "right to %.0f digits%s", digits, more ? " or more" : "");
    put(v, tone, first, ", ", drift);
}

/// An open loop, and its distance from the reference where that can be seen. A gap that grows is
/// said as it is now, one that does not as the largest so far.
static void judge_open(hn_motion_verdict *v, const sizes *s) {
    char open[96], far[96] = "", gap[HN_SI_TEXT], off[HN_SI_TEXT];
    quantity(s->grows ? s->gap_now : s->gap, "m", 2, gap);
    snprintf(open, sizeof open, "open by %s%s", gap, s->grows ? " and growing" : "");
    if (s->off > VISIBLE * s->length) {
        quantity(s->off, "m", 2, off);
        snprintf(far, sizeof far, "%s %s", off, s->grows ? "off" : "from the true motion");
    }
    put(v, HN_TONE_BAD, open, s->grows ? ", " : " and ", far);
}

static void judge_sizes(hn_motion_verdict *v, const sizes *s) {
    if (s->loops && s->gap > OPEN * s->length) {
        judge_open(v, s);
    } else if (s->off > WRONG * s->length) {
        judge_wrong(v, s, s->off, "m", "from the true motion");
    } else if (s->energy_scale > 0 && s->energy > WRONG * s->energy_scale) {
        judge_wrong(v, s, s->energy, "J", "off in energy");
    } else if (s->loops && s->gap > VISIBLE * s->length) {
        judge_open(v, s);
    } else {
        judge_right(v, s);
    }
}

hn_motion_verdict hn_motion_judge(const hn_motion_history *h) {
    static const char *const arrows[] = {"→", "→", "↗", "↘", "→"};
    hn_motion_verdict v = {.tone = HN_TONE_CALM, .arrow = "⇥"};

    // a method that had ended by now
    if (h->ended <= h->t) {
        v.tone = HN_TONE_BAD;
        snprintf(v.text, sizeof v.text, "stopped at %.2f s%s%.90s", h->ended, h->cause ? ": " : "",
                 h->cause ? h->cause : "");
        return v;
    }
    const trend is = trend_of(h);
    v.arrow = arrows[is];
    if (h->shown < HN_MOTION_EARLIEST) {
        snprintf(v.text, sizeof v.text, "%s", HN_STARTS_CLOSED);
        return v;
    }
    const sizes s = measure(h, is);
    judge_sizes(&v, &s);
    return v;
}
