// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HOLONOM_H
#define HOLONOM_H
// holonom as a library: load a mechanism, run it by several methods, compare them. This header is
// the whole interface; it needs nothing but the C library, and compiles as C and as C++.
//
//     holonom_mechanism *m;
//     holonom_fault fault;
//     if (holonom_load("four-bar", &m, &fault) != HOLONOM_OK) {
//         fprintf(stderr, "%s\n", fault.message);
//     }
//
// Link with what `pkg-config --libs holonom` prints. Units are SI: m, kg, s, rad, N.
// Coordinates are those of the scene, in its order. tests/library/example.c is a first program.
//
// Memory: every object is freed by its own function, and NULL may be freed. Pointers that a
// function returns belong to the object and are valid until the next call with that object.
// Threads: an object belongs to one thread at a time; different mechanisms may run in parallel.

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Outcome of a call; the numbers are the exit statuses of the program.
typedef enum holonom_status {
    HOLONOM_OK = 0,
    HOLONOM_INPUT = 2,   ///< the scene, the method or an argument is at fault; `fault` says where
    HOLONOM_PROGRAM = 3, ///< the library is at fault, or memory ran out
    HOLONOM_ENDED = 4    ///< a run ended early and says why: singular, diverged, step too small
} holonom_status;

/// A fault. Filled whenever a call does not return HOLONOM_OK; a NULL pointer is legal.
typedef struct holonom_fault {
    char where[192];   ///< JSON pointer into the scene ("/joints/2/axis"), or ""
    char message[512]; ///< what was found and what is allowed
    char hint[192];    ///< what to try, or ""
} holonom_fault;

// ---- mechanisms ----

/// A scene, compiled to equations and assembled: its loops are closed at the start.
typedef struct holonom_mechanism holonom_mechanism;

typedef struct holonom_sizes {
    int coordinates; ///< entries of q [m or rad] and of v [m/s or rad/s]
    int constraints; ///< entries of lambda [N or N m], redundant constraints included
    int dof;         ///< degrees of freedom at the start
    int redundant;   ///< constraints that depend on others at the start
    int points;      ///< points that a drawing needs
} holonom_sizes;

/// Loads a scene. `scene` is the name of a shipped one ("four-bar"), or the path of a file: it then
/// ends in .json or contains a '/'. Shipped scenes are found as the program finds them: where
/// HOLONOM_HOME points, or where `make install` put them.
/// Fails: HOLONOM_INPUT (no such scene, a scene at fault, loops that cannot be closed).
holonom_status holonom_load(const char *scene, holonom_mechanism **out, holonom_fault *fault);
/// Loads a scene from n bytes of JSON text.
holonom_status holonom_load_text(const char *json, size_t n, holonom_mechanism **out,
                                 holonom_fault *fault);
/// Changes a parameter of the scene, compiles and assembles it anew. Runs made before keep the old
/// mechanism. Fails: HOLONOM_INPUT; the mechanism is then unchanged.
holonom_status holonom_set(holonom_mechanism *m, const char *parameter, double value,
                           holonom_fault *fault);
void holonom_free(holonom_mechanism *m);

/// Returns the lengths of the arrays.
holonom_sizes holonom_get_sizes(const holonom_mechanism *m);
/// Name of coordinate i ("th1"), or of its rate ("w1"); NULL when there is no such coordinate.
const char *holonom_coordinate_name(const holonom_mechanism *m, int i);
const char *holonom_rate_name(const holonom_mechanism *m, int i);
/// Copies the assembled start: q and v, one entry a coordinate.
void holonom_start(const holonom_mechanism *m, double *q, double *v);

/// Solves  M a = f + J' lambda,  J a + gamma = 0  at one state.
///
/// q, v    in  one entry a coordinate; the loops need not be closed
/// a       out one entry a coordinate [m/s^2 | rad/s^2]
/// lambda  out one entry a constraint; the least-norm choice where constraints depend on each
///             other; may be NULL
/// Fails: HOLONOM_ENDED (singular, contradicting constraints), a and lambda are then untouched
holonom_status holonom_accelerations(holonom_mechanism *m, double t, const double *q,
                                     const double *v, double *a, double *lambda,
                                     holonom_fault *fault);

// ---- runs ----

/// One method on one mechanism.
typedef struct holonom_run holonom_run;

/// A state of a run. The arrays belong to the run, until its next call.
typedef struct holonom_sample {
    double t;
    const double *q, *v, *a; ///< one entry a coordinate
    const double *lambda;    ///< as of holonom_accelerations(); NaN where that fails
    const double *points;    ///< x, y, z of each point [m]
    double gap; ///< constraint violation of the positions, ||phi|| [m | rad, as the constraints]
    double velocity_gap; ///< constraint violation of the velocities, the same per second
    /// change of kinetic plus potential energy since the start, less `work` [J]
    double energy_change;
    double work; ///< of drives, dampers and loads since the start [J]
} holonom_sample;

/// The cost of a run and its constraint violation, so far.
typedef struct holonom_result {
    holonom_status status; ///< HOLONOM_ENDED when it ended early
    char reason[480];      ///< why, or ""
    double t;              ///< reached [s]
    double gap;            ///< largest, over all steps
    double velocity_gap;   ///< largest, over all steps
    double energy_change;  ///< largest, over all steps, less the work done [J]
    long long steps, evaluations;
    double operations; ///< arithmetic operations, exact; NaN: not counted
    double seconds;    ///< CPU time of stepping
} holonom_result;

/// Starts a run. `method` is spelled FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...], as in
/// "projection@rk4:h=1e-3". Fails: HOLONOM_INPUT (unknown method, a method that cannot serve this
/// mechanism).
holonom_status holonom_run_create(const holonom_mechanism *m, const char *method, holonom_run **out,
                                  holonom_fault *fault);
/// Steps to the time t and samples there. `out` may be NULL. Times must not decrease.
/// Fails: HOLONOM_ENDED with the reason; the run then stays at its last good state.
holonom_status holonom_run_to(holonom_run *run, double t, holonom_sample *out,
                              holonom_fault *fault);
holonom_result holonom_run_result(const holonom_run *run);
void holonom_run_free(holonom_run *run);

/// Runs n methods over the same time and reports each: `results` has n entries. A method that ends
/// early stays in the table with its status and reason. Fails: HOLONOM_INPUT at the first method
/// that cannot be started; `fault->where` is then "/methods/2".
holonom_status holonom_compare(const holonom_mechanism *m, const char *const *methods, int n,
                               double time, holonom_result *results, holonom_fault *fault);

/// Outcome of one of many runs.
typedef struct holonom_ending {
    holonom_status status; ///< HOLONOM_INPUT: the start is not finite; HOLONOM_ENDED: ended early
    double t;              ///< reached [s]
    long long steps;
} holonom_ending;

/// Runs one method from n starts, side by side: by the vector instructions and on all processors
/// that there are. Each ends bit for bit as it would by itself, in a fraction of the time.
///
/// method   in      index1 or baumgarte with alpha and beta, by euler, heun or rk4
/// time     in      end of every run [s], from 0: the first whole step that reaches it
/// q, v     in out  n rows, one entry a coordinate: the starts, then the last good states
/// endings  out     n
/// Fails: HOLONOM_INPUT where runs of this method or mechanism cannot step side by side; the fault
/// says why, and nothing has been run. Not to be called by two threads for one mechanism.
holonom_status holonom_run_many(const holonom_mechanism *m, const char *method, int n, double time,
                                double *q, double *v, holonom_ending *endings,
                                holonom_fault *fault);

#ifdef __cplusplus
}
#endif
#endif
