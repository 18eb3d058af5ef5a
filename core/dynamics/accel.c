#include "dynamics/eval.h"
#include "dynamics/inputs.h"
#include "dynamics/ldl.h"
#include "linalg/saddle.h"

#include <math.h>
#include <string.h>

// Rows that depend on others on the closed set come apart where the loops stand open: there J and gamma are off by about the gap
// over the length (and the velocity gap over the speed), a bit more in a loop of short links. What is not larger tells nothing.
static const double BLUR = 30;
static const double BLUR_MAX =
    1e-2; // a gap of a third of a per mille and more: pivots that size are real
static const double ROW_FLOOR =
    0.05; // a shorter row (of the longest) is mostly blur if stretched to unit length

struct hn_accel {
    int nv, nc;
    const hn_system *sys;
    hn_accel_opts opts;
    int available; ///< a static order exists
    hn_inputs in;  ///< outputs: a, lambda if wanted, then pivot and reference of each guard
    int n_out, n_guards;
    // behind it
    hn_eval *terms;
    hn_saddle_ws *saddle;
    double *gamma, *dense_a, *dense_lambda;
    long long count, fallbacks;
};

// compiling --------------------------------------------------------------------------------------------------------

/// Right-hand side of the closure rows: -(gamma + 2 alpha (J v + phi_t) + beta^2 phi).
static void closure_rhs(hn_system *sys, int baumgarte, hn_ex *rhs) {
    hn_graph *g = sys->g;
    if (!baumgarte) {
        for (int i = 0; i < sys->nc; i++) {
            rhs[i] = hn_neg(sys->gamma[i]);
        }
        return;
    }
    for (int i = 0; i < sys->nc; i++) {
        rhs[i] = sys->phi_t[i]; // gathers J v + phi_t
    }
    for (int k = 0; k < sys->J.n; k++) {
        const hn_entry *J = &sys->J.at[k];
        rhs[J->row] = hn_add(g, rhs[J->row], hn_mul(g, J->e, sys->v[J->col]));
    }
    hn_ex damping = hn_scale(2, sys->alpha), stiffness = hn_mul(g, sys->beta, sys->beta);
    for (int i = 0; i < sys->nc; i++) {
        hn_ex terms[3] = {sys->gamma[i], hn_mul(g, damping, rhs[i]),
                          hn_mul(g, stiffness, sys->phi[i])};
        rhs[i] = hn_neg(hn_sum(g, terms, 3));
    }
}

/// Outputs of the tape: a, lambda, guards. Returns owned, or NULL.
static hn_ex *list_outputs(hn_accel *s, hn_system *sys, const hn_ldl *ldl, const hn_ex *x) {
    hn_ex *outputs = malloc((3 * (size_t)ldl->n + 1) * sizeof *outputs);
    if (!outputs) {
        return NULL;
    }
    int n = 0;
    for (int i = 0; i < sys->nv + (s->opts.want_lambda ? sys->nc : 0); i++) {
        outputs[n++] = i < sys->nv ? x[i] : hn_neg(x[i]);
    }
    for (int k = 0; k < ldl->n_guards; k++) {
        outputs[n++] = ldl->guard[k][0];
        outputs[n++] = ldl->guard[k][1];
    }
    s->n_guards = ldl->n_guards;
    s->n_out = n;
    return outputs;
}

static hn_status compile_tape(hn_accel *s, hn_system *sys, hn_arena *arena) {
    hn_arena *scratch = hn_arena_create(0);
    if (!scratch) {
        return HN_ERR_MEMORY;
    }
    const hn_ldl_input in = {sys->nv, sys->nc, &sys->M, &sys->J, HN_ACCEL_PAIRS};
    hn_ldl ldl;
    hn_ex *x = NULL, *outputs = NULL;
    hn_status status = hn_ldl_build(sys->g, &in, scratch, &ldl);
    s->available = status == HN_OK && ldl.available;
    if (s->available) {
        x = hn_arena_get(scratch, ((size_t)ldl.n + 1) * sizeof *x);
        status = x ? HN_OK : HN_ERR_MEMORY;
    }
    if (status == HN_OK && s->available) {
        memcpy(x, sys->f, (size_t)sys->nv * sizeof *x);
        closure_rhs(sys, s->opts.baumgarte, x + sys->nv);
        status = hn_ldl_solve(sys->g, &ldl, x, x);
        outputs = status == HN_OK ? list_outputs(s, sys, &ldl, x) : NULL;
        status = outputs ? hn_inputs_compile(sys, outputs, s->n_out, arena, &s->in) : HN_ERR_MEMORY;
    }
    free(outputs);
    hn_arena_free(scratch);
    return status;
}

static hn_status prepare_dense(hn_accel *s, const hn_system *sys, hn_arena *arena) {
    const unsigned terms =
        HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA | HN_TERM_PHI | HN_TERM_PHI_T;
    s->saddle = hn_saddle_ws_create(arena, s->nv, s->nc);
    s->gamma = hn_arena_doubles(arena, (size_t)s->nc);
    s->dense_a = hn_arena_doubles(arena, (size_t)s->nv);
    s->dense_lambda = hn_arena_doubles(arena, (size_t)s->nc);
    if (!s->saddle || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    return hn_eval_create(sys, terms, arena, &s->terms);
}

static hn_status build(hn_accel *s, hn_system *sys, hn_arena *arena) {
    hn_status status = compile_tape(s, sys, arena);
    if (status == HN_OK && !s->available) {
        status = hn_inputs_create(sys, arena, &s->in);
    }
    return status == HN_OK ? prepare_dense(s, sys, arena) : status;
}

hn_status hn_accel_create(const hn_system *sys, const hn_accel_opts *opts, hn_arena *arena,
                          hn_accel **out) {
    HN_ASSERT(sys && opts && arena && out);
    hn_accel *s = hn_arena_get(arena, sizeof *s);
    *out = NULL;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->sys = sys;
    s->nv = sys->nv;
    s->nc = sys->nc;
    s->opts = *opts;
    hn_status status = build(s, (hn_system *)sys, arena);
    if (status != HN_OK) {
        hn_accel_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

void hn_accel_free(hn_accel *s) {
    if (s) {
        hn_inputs_free(&s->in);
        hn_eval_free(s->terms);
        s->terms = NULL;
    }
}

// running ----------------------------------------------------------------------------------------------------------

/// Smallest pivot relative to its reference; NaN counts as lost.
static double worst_pivot(const hn_accel *s) {
    const double *x = s->in.x;
    const uint16_t *slots = s->in.slots + s->n_out - 2 * s->n_guards;
    double worst = 1;
    for (int k = 0; k < s->n_guards; k++) {
        double ratio = fabs(x[slots[2 * k]]) / fabs(x[slots[2 * k + 1]]);
        if (!(ratio >= worst)) {
            worst = ratio;
        }
    }
    return worst >= 0 ? worst : 0;
}

/// Takes the tape's answer if all of it is finite.
static int take_answer(const hn_accel *s, double *a, double *lambda) {
    const double *x = s->in.x;
    const uint16_t *slots = s->in.slots;
    int n = s->n_out - 2 * s->n_guards;
    double zero = 0;
    for (int k = 0; k < n; k++) {
        zero += x[slots[k]] * 0; // a value that is not finite leaves NaN
    }
    if (!(zero == 0)) {
        return 0;
    }
    for (int i = 0; i < s->nv; i++) {
        a[i] = x[slots[i]];
    }
    for (int i = 0; lambda && i < s->nc; i++) {
        lambda[i] = x[slots[s->nv + i]];
    }
    return 1;
}

static int all_finite(const double *x, int n) {
    double zero = 0;
    for (int i = 0; i < n; i++) {
        zero += x[i] * 0; // a value that is not finite leaves NaN
    }
    return zero == 0;
}

/// Adds Baumgarte's terms to gamma; returns by how much the open gap blurs J and gamma (relative).
static double stabilise(hn_accel *s, const double *v, double alpha, double beta) {
    const double *J = hn_eval_get(s->terms, HN_TERM_J), *phi = hn_eval_get(s->terms, HN_TERM_PHI);
    const double *phi_t = hn_eval_get(s->terms, HN_TERM_PHI_T);
    const double length = hn_system_length(s->sys);
    double gap = 0, rates = 0, sizes = 0;
    for (int i = 0; i < s->nc; i++) {
        const double unit = hn_system_row_is_length(s->sys, i) ? length : 1;
        double rate = phi_t[i], size = fabs(phi_t[i]);
        for (int j = 0; j < s->nv; j++) {
            const double part = J[(size_t)i * (size_t)s->nv + (size_t)j] * v[j];
            rate += part;
            size = fmax(size, fabs(part));
        }
        gap = fmax(gap, fabs(phi[i]) / unit);
        rates = fmax(rates, fabs(rate) / unit);
        sizes = fmax(sizes, size / unit);
        if (s->opts.baumgarte) {
            s->gamma[i] += 2 * alpha * rate + beta * beta * phi[i];
        }
    }
    return fmax(gap, sizes > 0 ? rates / sizes : 0);
}

static hn_status solve_dense(hn_accel *s, double alpha, double beta, double *a, double *lambda,
                             hn_accel_info *info) {
    s->fallbacks++;
    if (!all_finite(s->in.x, s->in.n)) {
        return HN_ERR_DIVERGED;
    }
    const double *q = s->in.x, *v = q + s->in.nq;
    hn_eval_run(s->terms, v[s->nv], q, v);
    memcpy(s->gamma, hn_eval_get(s->terms, HN_TERM_GAMMA), (size_t)s->nc * sizeof *s->gamma);
    const double blur = fmin(BLUR * stabilise(s, v, alpha, beta), BLUR_MAX);
    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.row_floor = blur > opts.rank_tol ? ROW_FLOOR : 0;
    opts.rank_tol = fmax(opts.rank_tol, blur);
    opts.residual_tol = fmax(opts.residual_tol, blur);
    hn_saddle_info dense;
    hn_status status =
        hn_saddle_solve(s->nv, s->nc, hn_eval_get(s->terms, HN_TERM_M),
                        hn_eval_get(s->terms, HN_TERM_J), hn_eval_get(s->terms, HN_TERM_F),
                        s->gamma, s->dense_a, s->dense_lambda, &dense, &opts, s->saddle);
    if (status != HN_OK) {
        return status;
    }
    info->rank = dense.rank;
    info->residual = dense.residual;
    memcpy(a, s->dense_a, (size_t)s->nv * sizeof *a);
    if (lambda) {
        memcpy(lambda, s->dense_lambda, (size_t)s->nc * sizeof *lambda);
    }
    return HN_OK;
}

hn_status hn_accel_eval(hn_accel *s, double t, const double *q, const double *v, double alpha,
                        double beta, double *a, double *lambda, hn_accel_info *info) {
    HN_ASSERT(!lambda || s->opts.want_lambda);
    hn_accel_info own;
    info = info ? info : &own;
    s->count++;
    hn_inputs_set(&s->in, t, q, v, alpha, beta);
    *info = (hn_accel_info){.fallback = 1, .rank = s->nc, .pivot_ratio = 0, .residual = 0};
    if (s->available) {
        hn_tape_run(s->in.tape, s->in.x);
        info->pivot_ratio = worst_pivot(s);
        if (info->pivot_ratio >= HN_PIVOT_GUARD && take_answer(s, a, lambda)) {
            info->fallback = 0;
            return HN_OK;
        }
    }
    return solve_dense(s, alpha, beta, a, lambda, info);
}

hn_tape_info hn_accel_tape_info(const hn_accel *s) {
    return s->available ? hn_tape_get_info(s->in.tape) : hn_eval_info(s->terms);
}

long long hn_accel_count(const hn_accel *s) {
    return s->count;
}

long long hn_accel_fallbacks(const hn_accel *s) {
    return s->fallbacks;
}
