// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/verdict.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A gap that more than doubles from the first half of the motion to the second grows.
static const double GROWTH = 1.5;
/// One that has fallen below this share of the largest so far does not grow any more.
static const double FALLEN = 0.9;
static const int EARLIEST = 6;        // [frames] before it there is nothing to judge
static const double OPEN = 1e-2;      // of the scene's length: a gap that is the first thing to say
static const double VISIBLE = 1e-3;   // of the scene's length: a gap that can be seen
static const double WRONG = 1e-2;     // of the scene's length or energy: one digit is right at most
static const double CLOSED = 1e-12;   // of the scene's length: rounding
static const double ROUNDING = 1e-13; // [m] some hundred roundings of coordinates of a metre or so
static const double MOST_DIGITS = 15;

/// The largest magnitude of the frames from..to; NaN where none has one.
static double worst(const double *column, int from, int to) {
    double most = (double)NAN;
    for (int k = from; k <= to; k++) {
        const double size = fabs(column[k]);
        most = isnan(size) || size <= most ? most : size;
    }
    return most;
}

typedef enum trend { CLOSED_TREND, STARTED, GROWING, SHRINKING, HELD } trend;

static trend trend_of(const hn_track *track, int frame) {
    const double late = worst(track->gap, frame / 2, frame);
    if (!(late > ROUNDING)) {
        return CLOSED_TREND;
    }
    if (frame < EARLIEST) {
        return STARTED;
    }
    const double early = worst(track->gap, 0, frame / 2);
    const bool grows = late > GROWTH * early && fabs(track->gap[frame]) >= FALLEN * late;
    return grows ? GROWING : late < early / GROWTH ? SHRINKING : HELD;
}

typedef struct sizes {
    double gap_now, gap, off, energy; ///< [m], [m], [m], [J]
    double length, energy_scale, digits;
    bool loops, grows;
} sizes;

static void put(hn_verdict *v, hn_tone tone, const char *first, const char *second) {
    v->tone = tone;
    snprintf(v->text, sizeof v->text, "%.80s%s%.70s", first, first[0] && second[0] ? ", " : "",
             second);
}

/// "closed", "closed to 4.2 um", "open by 2.1 mm", or nothing for a mechanism without loops.
static void closed_words(const sizes *s, char *out, size_t size) {
    char gap[HN_SI_TEXT];
    hn_si_format(s->gap, "m", 1, gap);
    if (!s->loops) {
        out[0] = '\0';
    } else if (s->gap <= CLOSED * s->length) {
        snprintf(out, size, "closed");
    } else if (s->gap <= VISIBLE * s->length) {
        snprintf(out, size, "closed to %s", gap);
    } else {
        hn_si_format(s->gap, "m", 2, gap);
        snprintf(out, size, "open by %s", gap);
    }
}

static void judge_wrong(hn_verdict *v, const sizes *s, double value, const char *unit,
                        const char *what) {
    char first[64], number[HN_SI_TEXT], second[128];
    closed_words(s, first, sizeof first);
    hn_si_format(value, unit, 2, number);
    // a closed loop does not make a motion right, and an open one is one fault more
    const bool is_open = s->loops && s->gap > VISIBLE * s->length;
    snprintf(second, sizeof second, "%s%s %s", first[0] && !is_open ? "but " : "", number, what);
    if (is_open) {
        v->tone = HN_TONE_BAD;
        snprintf(v->text, sizeof v->text, "%.60s and %.90s", first, second);
    } else {
        put(v, HN_TONE_BAD, first, second);
    }
}

static void judge_right(hn_verdict *v, const sizes *s) {
    char drift[64] = "", first[64], number[HN_SI_TEXT];
    const hn_tone tone = s->loops && s->grows ? HN_TONE_WARN : HN_TONE_CALM;
    if (tone == HN_TONE_WARN) {
        hn_si_format(s->gap, "m", 2, number);
        snprintf(drift, sizeof drift, "gap %s and growing", number);
    }
    if (isnan(s->off)) {
        closed_words(s, first, sizeof first);
        put(v, tone, drift[0] ? drift : first, "error unknown");
        return;
    }
    const double share =
        fmax(fmax(s->off / s->length, s->energy_scale > 0 ? s->energy / s->energy_scale : 0),
             pow(10, -MOST_DIGITS));
    const double digits = fmin(floor(fmin(MOST_DIGITS, s->digits)), floor(-log10(share)));
    snprintf(first, sizeof first, "right to %.0f digits", digits);
    put(v, tone, first, drift);
}

/// A gap that grows is said as it is now, one that does not as the largest so far.
static void judge_open(hn_verdict *v, const sizes *s) {
    char text[96], gap[HN_SI_TEXT];
    hn_si_format(s->grows ? s->gap_now : s->gap, "m", 2, gap);
    snprintf(text, sizeof text, "open by %s%s", gap, s->grows ? " and growing" : "");
    put(v, HN_TONE_BAD, text, "");
}

static void judge(hn_verdict *v, const sizes *s) {
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

hn_verdict hn_verdict_at(const hn_recording *r, int track, int frame, double length, bool loops) {
    static const char *const arrows[] = {"→", "→", "↗", "↘", "→"};
    const hn_track *t = hn_recording_track(r, track);
    const hn_track_end end = hn_recording_end(r, track);
    hn_verdict v = {0};

    // a method that had ended by this frame
    if (isnan(t->gap[frame]) && end.failed) {
        v.tone = HN_TONE_BAD;
        v.arrow = "■";
        snprintf(v.text, sizeof v.text, "stopped at %.4g s", end.t);
        return v;
    }
    const trend is = trend_of(t, frame);
    v.arrow = arrows[is];
    if (frame < EARLIEST) {
        snprintf(v.text, sizeof v.text, "starts closed");
        return v;
    }

    const hn_recording_truth truth = hn_recording_get_truth(r);
    const sizes s = {.gap_now = t->gap[frame],
                     .gap = worst(t->gap, 0, frame),
                     .off = worst(t->error, 0, frame),
                     .energy = worst(t->energy_error, 0, frame),
                     .length = length > 0 ? length : 1,
                     .energy_scale = truth.energy_scale,
                     .digits = truth.digits,
                     .loops = loops,
                     .grows = is == GROWING};
    judge(&v, &s);
    return v;
}
