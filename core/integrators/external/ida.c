// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/ida_jacobian.h"
#include "integrators/external/ida_words.h"
#include "integrators/step/control.h"
#include "integrators/step/dae_base.h"
#include "integrators/step/options.h"

#include "formulations/ground/flops.h"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

// BDF of order 1 to 5 by SUNDIALS IDA under the library's own order and step control. IDA is made
// for index 1. With the constraints on speeds or positions its error test and the end test of its
// Newton iteration ask more of the multipliers than they can give, because their errors are divided
// by h. Forms that work then (measured, see the tests):
//
//     suppress=multipliers   the error test looks at q and v alone, and at index 3 (speeds) at q:
//                            errors of v are divided by h there, those of lambda by h^2
//     loosen=1e6             the Newton test has a 1e6 times larger absolute tolerance of lambda
//
// a first step that is not as small as rtol, which is what the library would choose (h0=-1), and a
// start with consistent accelerations. Local errors of BDF have one sign along an arc of the motion
// and add up: over the shipped scenes the error is some 900 times the tolerance that the library
// was given, twenty times what dopri5 makes of it (make tolerance). And the library's Newton test,
// 0.33 of the tolerance, leaves noise in the differences from which order and step are chosen: with
// 0.03 it takes a third fewer steps. So
//
//     safety=30              the library is given rtol / 30 and atol / 30, and its Newton test 1/30
//
// Written out as options so that their lack can be seen as well. The library allocates when an
// instance is made and started, and nothing in a step.

enum {
    OPT_RTOL,
    OPT_ATOL,
    OPT_H0,
    OPT_HMAX,
    OPT_SUPPRESS,
    OPT_LOOSEN,
    OPT_ORDER,
    OPT_JACOBIAN,
    OPT_SAFETY,
    N_OPTIONS
};
enum { JACOBIAN_EXACT, JACOBIAN_DIFFERENCES };
enum { SUPPRESS_AUTO, SUPPRESS_NONE, SUPPRESS_MULTIPLIERS, SUPPRESS_SPEEDS };
#define LOOSEN_HIGH_INDEX 1e6
#define H0_OF_LIBRARY -1
#define NEWTON_OF_LIBRARY 0.33 // of the tolerance: its default, IDASetNonlinConvCoef()
#define LEAST_RTOL 1e-12 // smaller ones are given as they are: rounding leaves no room for safety
#define LARGE 1e3 // times its unit: a multiplier below this keeps the tolerance that was asked for
#define SAME_STATE 1.0 // of the tolerance: a state changed by less goes on without a new start

typedef struct ida_stepper {
    hn_ida_problem problem;
    hn_ida_jacobian jacobian;            // not made with jacobian=differences
    double rtol, atol, h0, hmax, loosen; // tolerances as the library gets them
    double newton;                       // of the tolerance: what its iteration may leave
    double first;                        // step, 0: the library's choice
    int suppress, max_order, by_differences;
    bool default_atol;
    double *unit, *force_unit; // nq + nv, n - nq - nv: of the absolute tolerance
    SUNContext context;
    void *ida;
    int n; // of the vectors below
    N_Vector y, ydot, id, tolerance;
    SUNMatrix matrix;
    SUNLinearSolver solver;
    double *start_y, *start_ydot; // room of the problem
    double *lambda;               // nc
    double started;               // time of the last start
    double t, h;                  // end and size of the last step
    int changed;
    hn_cost cost; // of integrations before the last start
    char why[200];
} ida_stepper;

static double *data_of(N_Vector x) {
    return N_VGetArrayPointer(x);
}

// ---- what the library asks ----

static int give_residual(double t, N_Vector y, N_Vector ydot, N_Vector r, void *user) {
    ida_stepper *s = user;
    hn_ida_problem_residual(&s->problem, t, data_of(y), data_of(ydot), data_of(r));
    for (int i = 0; i < s->n; i++) {
        if (!isfinite(data_of(r)[i])) {
            return 1; // a shorter step may stay where the equations hold
        }
    }
    return 0;
}

static bool is_sparse(const ida_stepper *s) {
    return !s->by_differences && hn_ida_jacobian_is_sparse(&s->jacobian);
}

static void copy_columns(const hn_compressed *from, const double *values, SUNMatrix A) {
    const int n = from->n, entries = from->start[n];
    sunindextype *start = SUNSparseMatrix_IndexPointers(A), *row = SUNSparseMatrix_IndexValues(A);
    for (int i = 0; i <= n; i++) {
        start[i] = from->start[i];
    }
    for (int e = 0; e < entries; e++) {
        row[e] = from->row[e];
    }
    memcpy(SUNSparseMatrix_Data(A), values, (size_t)entries * sizeof *values);
}

static int give_jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector r, SUNMatrix A,
                         void *user, N_Vector work1, N_Vector work2, N_Vector work3) {
    ida_stepper *s = user;
    (void)r;
    (void)work1;
    (void)work2;
    (void)work3;
    if (is_sparse(s)) {
        const double *values;
        const hn_compressed *places =
            hn_ida_jacobian_fill_sparse(&s->jacobian, t, c, data_of(y), data_of(ydot), &values);
        copy_columns(places, values, A);
        return 0;
    }
    hn_ida_jacobian_fill(&s->jacobian, t, c, data_of(y), data_of(ydot), SUNDenseMatrix_Data(A));
    return 0;
}

static hn_tolerance tolerance_of(const ida_stepper *s) {
    return (hn_tolerance){s->rtol, s->atol, s->unit, hn_system_angles(s->problem.sys),
                          s->problem.nq};
}

// one over the error allowed in each entry; as the library's own, but for angles
static int give_weights(N_Vector y, N_Vector weight, void *user) {
    const ida_stepper *s = user;
    const hn_tolerance tol = tolerance_of(s);
    for (int i = 0; i < s->n; i++) {
        const double size = hn_tolerance_size(&tol, i, data_of(y)[i]);
        data_of(weight)[i] = 1 / (s->rtol * size + data_of(s->tolerance)[i]);
    }
    return 0;
}

// the library prints its messages otherwise; the flag that comes back says the same
static void be_silent(int code, const char *module, const char *function, char *message,
                      void *user) {
    (void)code;
    (void)module;
    (void)function;
    (void)message;
    (void)user;
}

// ---- life ----

static void free_integration(ida_stepper *s) {
    IDAFree(&s->ida);
    if (s->solver) {
        SUNLinSolFree(s->solver);
    }
    if (s->matrix) {
        SUNMatDestroy(s->matrix);
    }
    N_Vector vectors[] = {s->y, s->ydot, s->id, s->tolerance};
    for (int i = 0; i < 4; i++) {
        if (vectors[i]) {
            N_VDestroy(vectors[i]);
        }
    }
    s->ida = NULL;
    s->solver = NULL;
    s->matrix = NULL;
    s->y = s->ydot = s->id = s->tolerance = NULL;
}

static void destroy(void *self) {
    ida_stepper *s = self;
    free_integration(s);
    if (s->context) {
        SUNContext_Free(&s->context);
    }
    hn_ida_jacobian_free(&s->jacobian);
    hn_ida_problem_free(&s->problem);
}

static void take_options(ida_stepper *s, hn_dae_form form, const double *options) {
    const double asked = options[OPT_RTOL];
    s->rtol = fmax(asked / options[OPT_SAFETY], fmin(asked, LEAST_RTOL));
    const double share = s->rtol / asked;
    s->default_atol = !(options[OPT_ATOL] > 0);
    s->atol = s->default_atol ? s->rtol : options[OPT_ATOL] * share;
    s->newton = fmin(NEWTON_OF_LIBRARY, share);
    s->h0 = options[OPT_H0];
    s->hmax = options[OPT_HMAX];
    s->suppress = (int)options[OPT_SUPPRESS];
    if (s->suppress == SUPPRESS_AUTO) {
        s->suppress = form == HN_FORM_INDEX3 ? SUPPRESS_SPEEDS : SUPPRESS_MULTIPLIERS;
    }
    s->loosen = options[OPT_LOOSEN];
    if (!(s->loosen > 0)) {
        s->loosen = form == HN_FORM_INDEX1 || form == HN_FORM_STABILISED ? 1 : LOOSEN_HIGH_INDEX;
    }
    s->max_order = (int)options[OPT_ORDER];
    s->by_differences = options[OPT_JACOBIAN] == JACOBIAN_DIFFERENCES;
}

static hn_status create(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag) {
    ida_stepper *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;

    // options and equations that the library cannot serve
    if (hn_dae_close_option(form, form_options) > 0) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "use ggl@ida, or index2@radau5",
                           "ida cannot be used with projected positions (close): each projection "
                           "would discard its history of steps");
    }
    take_options(s, form, options);
    hn_status status = hn_dae_refuse_projecting(form, form_options, "ida", diag);
    if (status != HN_OK) {
        return status;
    }
    status = hn_ida_problem_init(&s->problem, sys, form, form_options, arena, diag);
    if (status != HN_OK) {
        return status;
    }

    // derivatives of the residual
    if (!s->by_differences) {
        status = hn_ida_jacobian_init(&s->jacobian, &s->problem, arena);
    }
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, "jacobian=differences needs less", "%s",
                           hn_status_text(status));
    }

    // start values and the context of the library
    const size_t room = (size_t)hn_ida_problem_room(&s->problem);
    s->start_y = hn_arena_doubles(arena, room);
    s->start_ydot = hn_arena_doubles(arena, room);
    s->lambda = hn_arena_doubles(arena, (size_t)s->problem.nc);
    s->unit = hn_arena_doubles(arena, (size_t)(s->problem.nq + s->problem.nv));
    s->force_unit = hn_arena_doubles(arena, room);
    if (hn_arena_failed(arena) || SUNContext_Create(NULL, &s->context) != 0) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return HN_OK;
}

// ---- start ----

static bool create_vectors(ida_stepper *s) {
    s->y = N_VNew_Serial(s->n, s->context);
    s->ydot = N_VNew_Serial(s->n, s->context);
    s->id = N_VNew_Serial(s->n, s->context);
    s->tolerance = N_VNew_Serial(s->n, s->context);
    s->matrix = is_sparse(s) ? SUNSparseMatrix(s->n, s->n, hn_ida_jacobian_puts(&s->jacobian),
                                               CSC_MAT, s->context)
                             : SUNDenseMatrix(s->n, s->n, s->context);
    return s->y && s->ydot && s->id && s->tolerance && s->matrix;
}

// which entries the error test looks at, and how exactly the Newton iteration has to find each
static void fill_weights(ida_stepper *s) {
    const int speeds = s->problem.nq, multipliers = speeds + s->problem.nv;

    // the tolerance of large multipliers, as of a heavy mechanism, is in units of their size
    double force = 0;
    for (int i = multipliers; i < s->n; i++) {
        force = fmax(force, fabs(s->start_y[i]));
    }
    hn_ida_problem_units(&s->problem, s->start_y + speeds, !s->default_atol, s->force_unit);
    for (int i = 0; i < s->n; i++) {
        const bool tested = s->suppress == SUPPRESS_SPEEDS ? i < speeds : i < multipliers;
        data_of(s->id)[i] = tested ? 1 : 0;

        // rounding is divided by h once more in the multipliers than in speeds that are not tested
        const double loosened =
            i < multipliers ? s->unit[i] * (tested ? 1 : sqrt(s->loosen))
                            : s->loosen * fmax(s->force_unit[i - multipliers], force / LARGE);
        data_of(s->tolerance)[i] = s->atol * loosened;
    }
}

// IDA's set-up functions say 0 or a negative flag each; the first fault counts
static int configure_ida(ida_stepper *s, double t) {
    int flag = IDAInit(s->ida, give_residual, t, s->y, s->ydot);
    flag = flag ? flag : IDASetErrHandlerFn(s->ida, be_silent, NULL);
    flag = flag ? flag : IDASetUserData(s->ida, s);
    flag = flag ? flag : IDAWFtolerances(s->ida, give_weights);
    flag = flag ? flag : IDASetNonlinConvCoef(s->ida, s->newton);
    flag = flag ? flag : IDASetId(s->ida, s->id);
    flag = flag ? flag : IDASetSuppressAlg(s->ida, s->suppress != SUPPRESS_NONE);
    flag = flag ? flag : IDASetMaxOrd(s->ida, s->max_order);
    flag = flag ? flag : IDASetInitStep(s->ida, s->first);
    flag = flag ? flag : IDASetMaxStep(s->ida, s->hmax);
    flag = flag ? flag : IDASetLinearSolver(s->ida, s->solver, s->matrix);
    if (!s->by_differences) {
        flag = flag ? flag : IDASetJacFn(s->ida, give_jacobian);
    }
    return flag;
}

static hn_status create_integration(ida_stepper *s, double t) {
    s->n = s->problem.n;
    if (!create_vectors(s)) {
        return HN_ERR_MEMORY;
    }
    s->solver = is_sparse(s) ? SUNLinSol_KLU(s->y, s->matrix, s->context)
                             : SUNLinSol_Dense(s->y, s->matrix, s->context);
    s->ida = IDACreate(s->context);
    if (!s->solver || !s->ida) {
        return HN_ERR_MEMORY;
    }
    fill_weights(s);
    memcpy(data_of(s->y), s->start_y, (size_t)s->n * sizeof(double));
    memcpy(data_of(s->ydot), s->start_ydot, (size_t)s->n * sizeof(double));
    return hn_ida_status(configure_ida(s, t), t, s->why, sizeof s->why);
}

/// Operations of a factorisation and of a solution.
typedef struct linear_work {
    double factor, solve;
} linear_work;

static linear_work work_of(const ida_stepper *s, long setups) {
    const double n = s->n;
    if (!is_sparse(s)) {
        return (linear_work){2 * n * n * n / 3, 2 * n * n};
    }
    if (setups == 0) {
        return (linear_work){0, 0};
    }
    sun_klu_numeric *numeric = SUNLinSol_KLUGetNumeric(s->solver);
    sun_klu_common *common = SUNLinSol_KLUGetCommon(s->solver);
    if (!numeric) {
        return (linear_work){0, 0}; // the matrix was singular
    }
    klu_l_flops(SUNLinSol_KLUGetSymbolic(s->solver), numeric, common);
    return (linear_work){
        common->flops,
        2.0 * ((double)numeric->lnz + (double)numeric->unz + (double)numeric->nzoff) + n};
}

static void add_counters(const ida_stepper *s, hn_cost *cost) {
    long residuals = 0, setups = 0, iterations = 0, errors = 0, failures = 0, extra = 0;
    if (!s->ida) {
        return;
    }

    // counters of the library
    IDAGetNumResEvals(s->ida, &residuals);
    IDAGetNumLinResEvals(s->ida, &extra);
    IDAGetNumLinSolvSetups(s->ida, &setups);
    IDAGetNumNonlinSolvIters(s->ida, &iterations);
    IDAGetNumErrTestFails(s->ida, &errors);
    IDAGetNumStepSolveFails(s->ida, &failures);
    const linear_work work = work_of(s, setups);

    // the same work in the units of the other methods
    cost->evals += residuals + extra;
    cost->factorisations += setups;
    cost->solves += iterations;
    cost->newton += iterations;
    cost->rejected += errors + failures;
    cost->ops += (double)(residuals + extra) * hn_ida_problem_ops(&s->problem) +
                 (double)setups * work.factor + (double)iterations * work.solve;
    if (!s->by_differences) {
        cost->ops += (double)setups * hn_ida_jacobian_ops(&s->jacobian);
    }
}

static hn_status choose_first_step(ida_stepper *s, double t, const double *y) {
    s->first = s->h0 > 0 ? s->h0 : 0;
    if (s->h0 != 0) {
        return HN_OK;
    }
    return hn_ida_problem_first_step(&s->problem, t, y, s->rtol, s->atol, s->unit,
                                     s->hmax > 0 ? s->hmax : HUGE_VAL, &s->first);
}

static hn_status start(void *self, double t, const double *y) {
    ida_stepper *s = self;
    hn_tolerance_units(s->problem.sys, !s->default_atol, y + s->problem.nq, s->unit);
    HN_TRY(choose_first_step(s, t, y));
    HN_TRY(hn_ida_problem_start(&s->problem, t, y, s->start_y, s->start_ydot));
    add_counters(s, &s->cost);
    free_integration(s);
    s->t = s->started = t;
    s->h = 0;
    s->changed = 0;
    s->why[0] = 0;
    return s->problem.n > 0 ? create_integration(s, t) : HN_OK;
}

// ---- a step ----

static bool is_another_state(const ida_stepper *s, const double *y) {
    const int n = s->problem.nq + s->problem.nv;
    const double *mine = data_of(s->y);
    double sum = 0;
    const hn_tolerance tol = tolerance_of(s);
    for (int i = 0; i < n; i++) {
        const double d = (y[i] - mine[i]) / hn_tolerance_of(&tol, i, y[i], y[i]);
        sum += d * d;
    }
    return sqrt(sum / n) > SAME_STATE;
}

static int step_of_library(ida_stepper *s, double t, double t_stop, double *t_new) {
    if (isfinite(t_stop)) {
        IDASetStopTime(s->ida, t_stop);
    }
    // the time asked for only sets the scale of the first step
    return IDASolve(s->ida, t + 1, t_new, s->y, s->ydot, IDA_ONE_STEP);
}

/// Starts again with other rows, as many as before: away from the start a state is off by the
/// tolerance, and redundant rows would seem independent.
static hn_status choose_rows_anew(ida_stepper *s, double t, const double *y) {
    s->problem.most_kept = s->problem.n_kept;
    const hn_status status = start(s, t, y);
    s->problem.most_kept = 0;
    return status;
}

static hn_status advance(void *self, double t, double t_stop, const double *y, double *t_new,
                         double *y_new) {
    ida_stepper *s = self;
    if (s->n == 0) {
        *t_new = fmin(t + (s->hmax > 0 ? s->hmax : 1), t_stop);
        return HN_OK;
    }
    if (s->changed && is_another_state(s, y)) {
        const hn_status status = start(self, t, y);
        if (status != HN_OK) {
            return status;
        }
    }
    s->changed = 0;
    if (t > s->started && !hn_ida_problem_rows_hold(&s->problem, t, y)) {
        HN_TRY(choose_rows_anew(s, t, y));
    }
    int flag = step_of_library(s, t, t_stop, t_new);

    // of redundant rows others may be independent by now: they are chosen anew, once at a place
    if (flag == IDA_CONV_FAIL && s->problem.n_kept < s->problem.nc && t > s->started) {
        HN_TRY(choose_rows_anew(s, t, y));
        flag = step_of_library(s, t, t_stop, t_new);
    }
    const hn_status status = hn_ida_status(flag, t, s->why, sizeof s->why);
    if (status != HN_OK) {
        hn_ida_add_remedy(&s->problem, status, s->why, sizeof s->why);
        return status;
    }
    memcpy(y_new, data_of(s->y), (size_t)(s->problem.nq + s->problem.nv) * sizeof *y_new);
    s->h = *t_new - t;
    s->t = *t_new;
    return HN_OK;
}

static void accepted(void *self, int changed) {
    ida_stepper *s = self;
    s->changed |= changed;
}

static void dense(void *self, double theta, double *y) {
    ida_stepper *s = self;
    const size_t n = (size_t)(s->problem.nq + s->problem.nv);
    if (s->n == 0) {
        return;
    }
    // `id` is only read when an integration starts, its room serves as scratch
    const int flag = IDAGetDky(s->ida, s->t - (1 - theta) * s->h, 0, s->id);
    HN_ASSERT(flag == IDA_SUCCESS);
    memcpy(y, data_of(s->id), n * sizeof *y);
}

static const double *raw_lambda(const void *self) {
    const ida_stepper *s = self;
    const double *y = s->n > 0 ? data_of(s->y) : s->start_y;
    hn_ida_problem_lambda(&s->problem, y, s->lambda);
    return s->lambda;
}

static void add_cost(const void *self, hn_cost *cost) {
    const ida_stepper *s = self;
    hn_cost_add(cost, &s->cost);
    add_counters(s, cost);
}

static const char *why(const void *self) {
    const ida_stepper *s = self;
    return s->why[0] ? s->why : NULL;
}

static const hn_dae_stepper dae = {
    .create = create,
    .destroy = destroy,
    .start = start,
    .advance = advance,
    .on_accepted = accepted,
    .dense = dense,
    .raw_lambda = raw_lambda,
    .add_cost = add_cost,
    .why = why,
};

static const char *const jacobians[] = {"exact", "differences"};
static const char *const suppressions[] = {"auto", "none", "multipliers", "speeds"};

const hn_stepper hn_stepper_ida = {
    .name = "ida",
    .title = "SUNDIALS IDA",
    .about = "SUNDIALS' solver for differential-algebraic systems: BDF of order 1 to 5, which "
             "chooses order and step itself. It is made for index 1. index2 and ggl work because "
             "their multipliers are left out of the error test. index3 leaves out the velocities "
             "too, so that rtol limits the errors of positions alone; with "
             "suppress=multipliers its steps collapse. The library is given a thirtieth of rtol, "
             "because its local errors add up "
             "(option safety). rtol limits the error of one step, not that of the motion: after 5 "
             "s the motion of a pole on a cart is off by about 30 times rtol; over the shipped "
             "scenes at "
             "rtol=1e-6 the median error is 23 times rtol, and one scene in ten has more than 1500 "
             "times rtol.",
    .source = "Hindmarsh et al. 2005; Brenan, Campbell & Petzold 1996",
    .order = 5,
    .stages = 1,
    .adaptive = true,
    .real_limit = HUGE_VAL,
    .imag_limit = 0, // order 3 and above are unstable next to the imaginary axis
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_RTOL] = HN_OPTION_RTOL,
            [OPT_ATOL] = HN_OPTION_ATOL,
            [OPT_H0] =
                {.key = "h0",
                 .min = H0_OF_LIBRARY,
                 .max = 100,
                 .unit = "s",
                 .about = "first step; 0: the step at which order 1 errs by the tolerance; -1: the "
                          "library's own choice"},
            [OPT_HMAX] = HN_OPTION_LARGEST_STEP,
            [OPT_SUPPRESS] =
                {.key = "suppress",
                 .max = 3,
                 .about = "variables left out of the error test: none, the multipliers, or the "
                          "velocities too (speeds); auto: speeds for index3, else multipliers",
                 .choices = suppressions,
                 .n_choices = 4},
            [OPT_LOOSEN] =
                {.key = "loosen",
                 .max = 1e12,
                 .about =
                     "absolute tolerance of the multipliers divided by atol; 0: 1 for index 1, 1e6 "
                     "above"},
            [OPT_ORDER] = {.key = "order",
                           .initial = 5,
                           .min = 1,
                           .max = 5,
                           .about = "highest order of the formula"},
            [OPT_JACOBIAN] =
                {.key = "jacobian",
                 .max = 1,
                 .about = "exact: from the equations; differences: the library's own difference "
                          "quotients",
                 .choices = jacobians,
                 .n_choices = 2},
            [OPT_SAFETY] = {.key = "safety",
                            .initial = 30,
                            .min = 1,
                            .max = 1e4,
                            .about = "the library is given rtol and atol over this, as its local "
                                     "errors add up; 1: the library as it comes"},
        },
    .forms = 1u << HN_FORM_INDEX1 | 1u << HN_FORM_STABILISED | 1u << HN_FORM_INDEX2 |
             1u << HN_FORM_GGL | 1u << HN_FORM_INDEX3,
    .dae = &dae,
};
