// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/run_internal.h"

#include <math.h>

// A limit is told once each time its coordinate leaves it, and again only after the coordinate has come back.

static const char *unit_of(const hn_coordinate *c) {
    return c->kind == HN_ANGLE ? " rad" : c->kind == HN_LENGTH ? " m" : "";
}

void hn_run_look_at_limits(hn_run *run) {
    hn_run_watch_state *w = &run->watch;
    const hn_scene *scene = hn_system_scene(run->sys);
    hn_limits_eval(w->limits, run->now.t, run->now.q, w->limited);
    for (int i = 0; i < hn_limits_count(w->limits); i++) {
        const hn_coordinate *c = &scene->coordinates[hn_limits_coordinate(w->limits, i)];
        const double x = w->limited[i];
        const int below = x < c->min, beyond = below || x > c->max;
        if (beyond && !w->beyond[i]) {
            const double limit = below ? c->min : c->max;
            hn_run_over(run, HN_INCIDENT_JOINT_LIMIT); // another coordinate's may still hold
            hn_run_tell(run, HN_INCIDENT_JOINT_LIMIT, c->name, x, limit,
                        "%s = %.6g%s has passed its limit of %.6g%s; nothing stops it there",
                        c->name, x, unit_of(c), limit, unit_of(c));
        }
        w->beyond[i] = (char)beyond;
    }
}
