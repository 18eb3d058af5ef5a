// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/energy.h"

#include "base/units.h"
#include "study/incidents/remedies.h"
#include "study/incidents/report.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool hn_energy_is_conservative(const hn_system *sys) {
    const hn_scene *scene = hn_system_scene(sys);
    for (int i = 0; i < scene->n_loads; i++) {
        const hn_load *load = &scene->loads[i];
        const bool spring = load->kind == HN_LOAD_SPRING || load->kind == HN_LOAD_JOINT_SPRING;
        if (!spring || load->damping.value != 0 || load->damping.varies) {
            return false;
        }
    }
    return !hn_system_get_info(sys).has_time;
}

/// Share of the tolerance: steps whose errors it accepts change these sums by less.
static const double TOLERATED = 0.1;

/// Energies are sums of terms as large as weights times lengths, whatever their sum is: rounding
/// changes them by some eps of that, and steps chosen from a tolerance by a part of the tolerance,
/// however small the first energies of a motion from rest are. ROUNDINGS is what 1e5 steps of a
/// swinging chain leave at most.
static double noise_of(const hn_watch *w) {
    enum { ROUNDINGS = 10000 };
    const hn_scene *scene = hn_system_scene(w->run->sys);
    double mass = 0, gravity = 0;
    for (int i = 0; i < scene->n_bodies; i++) {
        mass += scene->bodies[i].mass.value;
    }
    for (int i = 0; i < 3; i++) {
        gravity = hypot(gravity, scene->gravity[i].value);
    }
    const double size = fabs(w->measure.potential) + w->measure.kinetic;
    const double creep = ROUNDINGS * DBL_EPSILON * w->length; // in a second: what rests may do
    const double tolerated = w->run->adaptive ? TOLERATED * w->run->tol.rtol : 0;
    return fmax(ROUNDINGS * DBL_EPSILON, tolerated) * (size + mass * gravity * w->length) +
           mass * creep * creep;
}

void hn_energy_start(hn_watch *w) {
    hn_energy_record *e = &w->energy;
    e->v_min = e->v_max = w->measure.potential;
    e->t_max = w->measure.kinetic;
    e->start = e->last = w->measure.kinetic + w->measure.potential;
    e->change = 0;
    e->noise = noise_of(w);
}

void hn_energy_record_state(hn_watch *w) {
    hn_energy_record *e = &w->energy;
    const double energy = w->measure.kinetic + w->measure.potential - w->work.done;
    const double potential = w->measure.potential, kinetic = w->measure.kinetic;
    e->v_min = potential < e->v_min ? potential : e->v_min; // not a call of fmin(): every step
    e->v_max = potential > e->v_max ? potential : e->v_max;
    e->t_max = kinetic > e->t_max ? kinetic : e->t_max;
    e->change = energy - e->last;
    e->last = energy;
}

/// Says whether a change of energy is worth a report.
static bool is_large(const hn_watch *w, double change, double limit) {
    const double noise = w->energy.noise;
    return w->energy.conservative && limit != 0 && fabs(change) > (limit > noise ? limit : noise);
}

/// The change in one step that is reported [J].
static double jump_limit(const hn_watch *w) {
    const hn_energy_record *e = &w->energy;
    return HN_RUN_WARN_ENERGY * (w->measure.kinetic + (e->v_max - e->v_min)) * w->every;
}

// A method can lose all energy little by little, without a jump. One report of a run says it: the
// limit grows with the energies of the motion, and a change near it passes it many times. What one
// step has changed is reported as a jump.
static void check_drift(hn_watch *w) {
    const hn_energy_record *e = &w->energy;
    const int *reported = w->log.reported;
    const double change = e->last - e->start;
    const double limit = HN_RUN_WARN_DRIFT * (e->t_max + (e->v_max - e->v_min));
    if (!is_large(w, change, limit) || is_large(w, e->change, jump_limit(w)) ||
        reported[HN_INCIDENT_ENERGY_DRIFT] > 0 || reported[HN_INCIDENT_ENERGY_JUMP] > 0) {
        return;
    }
    const int digits = hn_digits_apart(fabs(change), limit, 3);
    hn_incident_report(w, &hn_incident_energy_drift, "energy change", change, limit,
                       "the energy has changed by %.*g J since the start, more than %.*g J, and no "
                       "load does work; the limit is %g %% of the largest energies so far",
                       digits, change, digits, limit, 100 * HN_RUN_WARN_DRIFT);
}

static void check_jump(hn_watch *w) {
    const hn_energy_record *e = &w->energy;
    const double limit = jump_limit(w);
    if (!is_large(w, e->change, limit)) {
        hn_incident_over(&w->log, HN_INCIDENT_ENERGY_JUMP);
        return;
    }
    if (!hn_incident_begins(&w->log, HN_INCIDENT_ENERGY_JUMP)) { // before its text is made
        return;
    }
    const int digits = hn_digits_apart(fabs(e->change), limit, 3);
    hn_incident_put(w, &hn_incident_energy_jump, "energy change", e->change, limit,
                    "the energy changed by %.*g J in one step, more than %.*g J, and no load "
                    "does work; since the start it has changed by %.3g J",
                    digits, e->change, digits, limit, e->last - e->start);
}

/// Share of the largest kinetic energy and the range of the potential: a motion whose energy has
/// changed by more is another motion.
static const double ANOTHER = 0.2;

void hn_energy_explain(const hn_watch *w, char why[256]) {
    const hn_energy_record *e = &w->energy;
    const double change = e->last - e->start;
    const double size = e->t_max + (e->v_max - e->v_min);
    const size_t used = strlen(why);
    if (e->conservative && fabs(change) > ANOTHER * size) {
        const int more =
            snprintf(why + used, 256 - used,
                     "; the energy had changed by %.3g J before, " HN_ENERGY_ANOTHER, change);
        why[more < 256 - (int)used ? (int)used + more : (int)used] = '\0'; // no half a number
    }
}

static bool is_kept(const hn_watch *w) {
    return w->energy.conservative;
}

const hn_incident_kind hn_incident_energy_drift = {
    .code = HN_INCIDENT_ENERGY_DRIFT,
    .each_step = true,
    .is_possible = is_kept,
    .is_wrong = true,
    .spelling = "energy-drift",
    .name = "the energy drifted",
    .rule = "A mechanism keeps its energy where no load (damper, drive, applied force) does work; "
            "gravity and springs are part of the energy. A slow gain or loss is the error of the "
            "method, and the motion becomes faster or slower with it. The limit is a share of the "
            "largest kinetic energy plus the range of the potential energy.",
    .check = check_drift,
    .remedies = {{hn_remedy_finer, 0.25}, {hn_remedy_right_model, 0}, {hn_remedy_stiff_closed, 0}},
};

const hn_incident_kind hn_incident_energy_jump = {
    .code = HN_INCIDENT_ENERGY_JUMP,
    .each_step = true,
    .is_possible = is_kept,
    .is_wrong = true,
    .spelling = "energy-jump",
    .name = "the energy jumped",
    .rule = "A mechanism keeps its energy where no load (damper, drive, applied force) does work; "
            "gravity and springs are part of the energy. A jump within one step means that the "
            "step is wrong, even where the loops stay closed.",
    .check = check_jump,
    .remedies = {{hn_remedy_finer, 0.25}, {hn_remedy_right_model, 0}, {hn_remedy_stiff_closed, 0}},
};
