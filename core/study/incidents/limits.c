// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/limits.h"

#include "base/units.h"
#include "study/incidents/report.h"

static const char *unit_of(const hn_coordinate *c) {
    return c->kind == HN_ANGLE ? " rad" : c->kind == HN_LENGTH ? " m" : "";
}

static void check(hn_watch *w) {
    const hn_scene *scene = hn_system_scene(w->run->sys);
    hn_limits_eval(w->limits, w->run->now.t, w->run->now.q, w->limited);
    for (int i = 0; i < hn_limits_count(w->limits); i++) {
        const hn_coordinate *c = &scene->coordinates[hn_limits_coordinate(w->limits, i)];
        const double x = w->limited[i];
        const bool below = x < c->min, beyond = below || x > c->max;
        if (beyond && !w->beyond[i]) {
            const double limit = below ? c->min : c->max;
            const int digits = hn_digits_apart(x, limit, 6);
            hn_incident_over(&w->log,
                             HN_INCIDENT_JOINT_LIMIT); // another coordinate's may still hold
            hn_incident_report(w, &hn_incident_joint_limit, c->name, x, limit,
                               "%s = %.*g%s has passed its limit of %.*g%s; nothing stops it there",
                               c->name, digits, x, unit_of(c), digits, limit, unit_of(c));
        }
        w->beyond[i] = beyond;
    }
}

static bool has_limits(const hn_watch *w) {
    return hn_limits_count(w->limits) > 0;
}

const hn_incident_kind hn_incident_joint_limit = {
    .code = HN_INCIDENT_JOINT_LIMIT,
    .each_step = true,
    .is_possible = has_limits,
    .spelling = "joint-limit",
    .name = "a coordinate passed its limit",
    .rule = "A limit in a scene is watched, not enforced: no force holds the coordinate there.",
    .check = check,
};
