// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_WATCH_H
#define HN_STUDY_WATCH_H
// Monitors a run: after a step it measures the state that has been reached and checks it against
// the table of incidents (kinds.h). It reads the state of the stepping part and never changes it.

#include "dynamics/analyse/singularity_monitor.h"
#include "dynamics/assembly/mode.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/limits.h"
#include "study/incidents/log.h"
#include "study/incidents/rows.h"
#include "study/incidents/work.h"
#include "study/stepping/stepping.h"

#define HN_RUN_WARN_GAP 1e-3 ///< gap / characteristic length that is reported
/// Gap / characteristic length that ends a run. The rows of J are lever arms of about that length.
/// With the pins of a joint half a length apart, the rows point up to 30 degrees in the wrong
/// direction, and the computed motion is no motion of this mechanism.
#define HN_RUN_LOST_GAP 0.5
#define HN_RUN_WARN_PIVOT 1e-4 ///< pivot ratio of K that is reported as near-singular
/// Energy change in one step / (T + range of V), conservative scenes only.
#define HN_RUN_WARN_ENERGY 1e-2
/// Energy change since the start / (largest T + range of V), conservative scenes only.
#define HN_RUN_WARN_DRIFT 1e-2
/// Condition number of the equilibrated K: half the digits of the multipliers are lost.
#define HN_RUN_WARN_CONDITION 1e8
/// Growth of |lambda| over its largest value away from singular configurations, divided by the
/// growth of the kinetic energy over its own.
#define HN_RUN_WARN_MULTIPLIERS 1e3
/// [rad] between the direction of motion and its smooth continuation.
#define HN_RUN_WARN_TURN 0.5
/// Share of the displacement of a step that velocity times time does not account for.
#define HN_RUN_WARN_JUMP 0.5
/// A reversal of the velocities within one step is reported if |v + v_before| is below this share
/// of the velocity, and the accelerations explain less than this share of the change.
#define HN_RUN_WARN_BACK 0.3
/// Least change of the assembly-mode value that counts as a jump to the other branch.
#define HN_RUN_WARN_MODE 0.1

/// The measurements at one state.
typedef struct hn_measure {
    double gap, velocity_gap;  ///< ||phi||, ||J v + phi_t||
    double kinetic, potential; ///< [J]
} hn_measure;

/// Energy so far.
typedef struct hn_energy_record {
    double start; ///< total energy at the start [J]
    /// total energy now less the work of drives, dampers and loads since the start, and its change
    /// in the last step
    double last, change;
    double v_min, v_max, t_max; ///< range of the potential, largest kinetic energy
    double noise;               ///< changes up to this are rounding, or tolerated [J]
    bool conservative;          ///< no load does work that the energy does not contain
} hn_energy_record;

/// The direction of motion, in velocities scaled by the masses and of unit length.
typedef struct hn_heading {
    double t;
    /// nv + 1: the velocities, then the part of time: 0 unless the mechanism is driven and has no
    /// degree of freedom of its own
    double *e;
} hn_heading;

/// The directions of motion so far, and where the run entered a configuration in which J is nearly
/// rank deficient.
typedef struct hn_heading_record {
    hn_heading older, last, now; ///< the first two away from singular configurations
    int n;
    hn_state_at outside; ///< the state where `last` was taken
    double fastest;      ///< largest scaled velocities so far
    double *smooth;      ///< nv + 1: a heading continued
    /// the accelerations lead from `outside`, where `last` was taken, to the present direction
    bool explained;
    bool driven;     ///< the constraints move with time
    double *entered; ///< nq: where J all but lost rank, as long as it stays so
    int inside;      ///< 0: J has full rank; 1: it has all but lost rank; 2: that was reported
} hn_heading_record;

/// Singular configurations that the run has met or is predicted to meet.
typedef struct hn_singular_record {
    hn_singularity *monitor;
    hn_singularity_info info; ///< at the last check
    double largest;           ///< sigma_min so far
    double multiplier;        ///< largest |lambda| away from singular configurations
    double kinetic;           ///< largest kinetic energy there [J]
    long long fallbacks;      ///< of the method, as reported so far
    /// The latest prediction: 1 + number of its report, 0: none is open; the lowest sigma_min
    /// since.
    int announced;
    double lowest;
    double due;    ///< time of the latest prediction [s]
    int passing;   ///< 1 + number of the report on the configuration being passed, 0: none
    bool at_start; ///< the run starts in a singular configuration
    // a state inside the last step
    double *inside_q;       ///< nq
    double *inside, *whole; ///< nv: from the start of the step to that state, and to its end
} hn_singular_record;

struct hn_watch {
    const hn_stepping *run;
    const hn_cost *cost; ///< of the run so far
    double warn_gap;     ///< times the characteristic length
    double t_end;        ///< end that the run is for [s]; 0: not known
    double length;       ///< characteristic length [m]
    hn_incident_log log;
    int every; ///< a check every so many steps
    /// For each report whose remedies may be tried: a state shortly before it, and the number of
    /// steps by then.
    hn_state_at *before;  ///< HN_RUN_MAX_INCIDENTS
    long long *before_at; ///< HN_RUN_MAX_INCIDENTS
    int diagnosed;        ///< reports whose cause was looked for and whose remedies were tried
    bool at_start;        ///< the start is being checked, no step has been made

    // of the state measured last
    hn_measure measure;

    // of the state checked in full last
    double *checked_q;   ///< nq
    double checked_t;    ///< its time [s]
    double stride;       ///< way from there to the next full check, over the length
    double near_until;   ///< before this time the run is too near it for another check [s]
    double shortest_row; ///< hn_motion_shortest_row() there
    const hn_incident_kind *each_step[HN_INCIDENT_COUNT]; ///< those checked after every step
    int n_each_step;
    unsigned own_pace; ///< incidents that end without a full check: bits of hn_incident_log.active
    long long checks;  ///< full checks so far
    bool calm;         ///< it found nothing that the next step has to be compared with
    hn_status accel_status;
    hn_accel_info accel_info;
    double *a, *lambda; ///< nv, nc
    double *scratch;    ///< nv
    int start_rank;     ///< rank of J at the start
    hn_status failure;  ///< why the run ended, HN_OK while it goes on

    double worst_gap, worst_velocity_gap, worst_energy_change;
    double swiftest;  ///< largest velocity so far
    double *row_size; ///< nc: largest length of each row of J so far
    hn_energy_record energy;
    hn_work_record work; ///< of drives, dampers and loads
    hn_heading_record heading;
    hn_singular_record singular;
    double *modes, *last_modes; ///< per loop: assembly modes now and at the last check
    int held;                   ///< recent steps at the stability limit
    int released;               ///< steps since the last of them
    long long restarts;         ///< steps after which a multistep integrator had to start again
    char *beyond;               ///< per limit: it is passed at present
    double *limited;            ///< values of the coordinates with limits

    hn_eval *eval; ///< of every state: phi, phi_t, J v + phi_t, energy
    const double *phi, *phi_t, *closure_rates, *energies; ///< its values
    hn_eval *rows_eval;                                   ///< of states checked in full
    hn_closure_rows rows;
    hn_mode_watch *mode;
    hn_limits *limits;
};

/// Makes the watching half of a run; memory from its arena. `cost` is borrowed. Fails:
/// HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_watch_create(const hn_stepping *run, const hn_cost *cost,
                                        double warn_gap, hn_watch *w);
void hn_watch_free(hn_watch *w);
/// Forgets the past and checks the start.
void hn_watch_start(hn_watch *w);
/// Counts an accepted step; measures nothing.
void hn_watch_step(hn_watch *w);
/// Returns whether every accepted step is measured: hn_watch_measure_step().
bool hn_watch_measures_steps(const hn_watch *w);
/// Adds the work done in the last step, which has to be summed over every step.
void hn_watch_measure_step(hn_watch *w);
/// Returns the change of energy since the start less the work done since [J], and writes that work
/// to *work. `at` lies in the last step or less than a step ahead. NaN where the work is not known.
double hn_watch_energy_change(hn_watch *w, const hn_state_at *at, const hn_measure *m,
                              double *work);
/// Checks the present state of the run against the table of incidents. Fails with HN_ERR_DIVERGED
/// and the reason in `why` where the loops are open by HN_RUN_LOST_GAP or more.
HN_MUST_CHECK hn_status hn_watch_check(hn_watch *w, char why[256]);
/// Returns the singular values of the scaled J at the present state of the run; where they cost too
/// much, at the state checked in full last.
hn_singularity_info hn_watch_singularity(const hn_watch *w);
/// Measures any state.
hn_measure hn_watch_measure(hn_watch *w, double t, const double *q, const double *v);

#endif
