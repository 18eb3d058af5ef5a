// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stepping/headway.h"

#include "study/stepping/stepping.h"

#include <math.h>
#include <stdio.h>

// Trial steps in a window: few enough to take a fraction of a second, enough to measure a pace that
// one difficult part of the motion does not decide.
enum { WINDOW = 1000, WINDOWS_TO_END = 4 };

hn_status hn_headway_check_steps(hn_stepping *s, double t_end) {
    const double h = s->h_next;
    const double allowed = (double)(s->max_steps - s->steps);
    if (s->adaptive || !(h > 0) || (t_end - s->now.t) / h <= allowed + 1) {
        return HN_OK;
    }
    snprintf(s->reason, sizeof s->reason,
             "h = %.3g s needs %.3g steps to reach t = %.6g s, and %.3g are allowed; take a longer "
             "step or a shorter time",
             h, (t_end - s->now.t) / h, t_end, allowed);
    return HN_ERR_STOPPED;
}

void hn_headway_describe(const hn_stepping *s, char *out, size_t size) {
    const hn_headway *p = &s->headway;
    const char *why = hn_engine_why(&s->engine);
    if (why && why[0]) {
        snprintf(out, size, "%s", why);
    } else if (2 * p->refused > p->tried) {
        snprintf(out, size, "the error estimate rejects %lld of %lld trial steps", p->refused,
                 p->tried);
    } else if (s->h > 0) {
        snprintf(out, size, "the error estimate holds the step at %.2g s", s->h);
    } else {
        snprintf(out, size, "no step that the time can count keeps the error within its tolerance");
    }
}

hn_status hn_headway_step(hn_stepping *s) {
    hn_headway *p = &s->headway;
    const long long attempts = s->steps + s->rejected;
    if (!s->adaptive || attempts - p->attempts < WINDOW) {
        return HN_OK;
    }

    // steps to the time asked for, at the pace of this window
    const double left = fmax(0, s->t_asked - s->now.t);
    p->advance = s->now.t - p->t;
    p->tried = attempts - p->attempts;
    p->refused = s->rejected - p->rejected;
    p->needed = p->advance > 0 ? left / p->advance * (double)p->tried : HUGE_VAL;
    p->t = s->now.t;
    p->attempts = attempts;
    p->rejected = s->rejected;

    // one slow window may be a difficult part of the motion; several are a collapse
    p->slow = p->needed > (double)(s->max_steps - attempts) ? p->slow + 1 : 0;
    if (p->slow < WINDOWS_TO_END) {
        return HN_OK;
    }
    char cause[160];
    hn_headway_describe(s, cause, sizeof cause);
    snprintf(s->reason, sizeof s->reason,
             "the steps collapsed at t = %.6g s: %.2g s in %lld trial steps; %s", s->now.t,
             p->advance, p->tried, cause);
    return HN_ERR_STEP_UNDERFLOW;
}
