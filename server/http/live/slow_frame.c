// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/slow_frame.h"

#include "base/clock.h"

#include <stdio.h>

/// A frame that has taken so much computing, and more than the clock gives it, is reported [s].
static const double SLOW = 0.25;
/// Between two reports [s].
static const double AGAIN = 1;

void hn_slow_frame_begin(hn_slow_frame *slow) {
    slow->begun = hn_clock_thread();
}

void hn_slow_frame_end(hn_slow_frame *slow, bool is_whole) {
    slow->used = is_whole ? 0 : slow->used + hn_clock_thread() - slow->begun;
}

/// The sentence for people, and what to do.
static void put_words(hn_strbuf *b, const hn_comparison *c, int method, double slowness,
                      double speed) {
    char spelling[HN_SPEC_MAX], text[HN_SPEC_MAX + 200];
    const double dt = hn_comparison_frame_dt(c);
    hn_method_format(hn_run_spec(hn_comparison_run(c, method)), spelling);
    snprintf(text, sizeof text,
             "%s runs %.3g times slower than the clock: the next frame, %.3g s of motion, takes "
             "about %.3g s of computing",
             spelling, slowness * speed, dt, slowness * dt);
    hn_json_put_string(b, "detail", text);
    snprintf(text, sizeof text,
             "take a larger step, or an integrator that chooses its own%s; a method that needs "
             "more than %g s for a frame is stopped",
             speed > 1 ? ", or a lower speed" : "", hn_comparison_cpu_limit(c));
    hn_json_put_string(b, "hint", text);
}

bool hn_slow_frame_report(hn_slow_frame *slow, const hn_comparison *c, double speed, hn_strbuf *b) {
    const double used = slow->used + hn_clock_thread() - slow->begun, now = hn_clock_wall();
    double slowness = 0;
    if (used < SLOW || used * speed < hn_comparison_frame_dt(c) ||
        (slow->told > 0 && now < slow->told + AGAIN)) {
        return false;
    }
    const int method = hn_comparison_slowest(c, &slowness);
    if (method < 0 || slowness * speed <= 1) {
        return false;
    }
    slow->told = now;
    hn_json_put_int(b, "frame", hn_comparison_frame(c) + 1);
    hn_json_put_int(b, "method", method);
    hn_json_put_number(b, "slowness", slowness);
    hn_json_put_number(b, "computed_s", used);
    put_words(b, c, method, slowness, speed);
    return true;
}
