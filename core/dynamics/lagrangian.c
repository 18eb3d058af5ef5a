#include "dynamics/lagrangian.h"

#include <math.h>
#include <stdlib.h>

/// Scratch expressions of one call, freed at once.
typedef struct scratch {
    hn_ex *p, *seed, *a, *b; ///< n + 1 (or m) each
    int *symbols;            ///< n + 1: q, then t
} scratch;

static int scratch_create(scratch *s, const hn_lagrange_input *in) {
    const size_t n = (size_t)(in->n > in->m ? in->n : in->m) + 1;
    s->p = calloc(4 * n, sizeof *s->p);
    s->symbols = calloc((size_t)in->n + 1, sizeof *s->symbols);
    if (!s->p || !s->symbols) {
        return 0;
    }
    s->seed = s->p + n;
    s->a = s->p + 2 * n;
    s->b = s->p + 3 * n;
    return 1;
}

static void scratch_free(scratch *s) {
    free(s->p);
    free(s->symbols);
}

static int depends_on_any(const hn_graph *g, hn_ex e, const int *symbols, int n) {
    for (int i = 0; i < n; i++) {
        if (hn_depends_on(g, e, symbols[i])) {
            return 1;
        }
    }
    return 0;
}

/// What the formulas must not depend on, told before anything is differentiated.
static hn_status check_dependence(const hn_graph *g, const hn_lagrange_input *in, hn_diags *diags) {
    if (hn_depends_on(g, in->kinetic, in->t)) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/lagrangian/kinetic",
            "drive a coordinate by a constraint instead",
            "the kinetic energy depends on t; it must be a quadratic form in the rates");
    }
    if (depends_on_any(g, in->potential, in->v, in->n)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/lagrangian/potential", "put dampers into forces",
                            "the potential energy depends on a rate");
    }
    for (int i = 0; i < in->m; i++) {
        if (depends_on_any(g, in->constraints[i], in->v, in->n)) {
            char pointer[64] = "/lagrangian/constraints";
            return hn_diags_add(
                diags, HN_ERR_INPUT, pointer, "write it between coordinates and t",
                "constraint %d depends on a rate; only holonomic constraints are served", i + 1);
        }
    }
    return HN_OK;
}

/// T must equal v' M v / 2 with M free of v; M's own formulas show the second, three arbitrary states the first.
static hn_status check_quadratic(hn_graph *g, const hn_lagrange_input *in, const hn_ex *M,
                                 hn_diags *diags) {
    hn_ex rest = hn_scale(-1, in->kinetic);
    for (int i = 0; i < in->n; i++) {
        for (int j = 0; j <= i; j++) {
            const hn_ex m = M[i * in->n + j];
            if (depends_on_any(g, m, in->v, in->n)) {
                return hn_diags_add(diags, HN_ERR_INPUT, "/lagrangian/kinetic", NULL,
                                    "the kinetic energy is not quadratic in the rates");
            }
            const hn_ex vv =
                hn_mul(g, hn_graph_symbol_expr(g, in->v[i]), hn_graph_symbol_expr(g, in->v[j]));
            rest = hn_add(g, rest, hn_scale(i == j ? 0.5 : 1, hn_mul(g, m, vv)));
        }
    }
    const int n_symbols = hn_graph_n_symbols(g);
    double *x = calloc((size_t)n_symbols + 1, sizeof *x);
    if (!x) {
        return HN_ERR_MEMORY;
    }
    int quadratic = 1;
    for (int k = 1; k <= 3; k++) {
        for (int i = 0; i < n_symbols; i++) {
            x[i] = 0.3 + 0.61803398875 * fmod(i * 0.754877666 + k * 0.569840291, 1.0);
        }
        const double T = hn_graph_eval(g, in->kinetic, x), off = hn_graph_eval(g, rest, x);
        // some hundred roundings of terms as large as T; a state outside a formula's domain says nothing
        quadratic &= !(isfinite(T) && isfinite(off)) || fabs(off) <= 1e-9 * (1 + fabs(T));
    }
    free(x);
    return quadratic
               ? HN_OK
               : hn_diags_add(diags, HN_ERR_INPUT, "/lagrangian/kinetic",
                              "each term needs two rates, as in m*v^2/2",
                              "the kinetic energy has terms that are not quadratic in the rates");
}

static void calc_mass_and_force(hn_graph *g, const hn_lagrange_input *in, const scratch *s,
                                hn_ex *M, hn_ex *f) {
    const int n = in->n;
    hn_diff_reverse(g, in->kinetic, in->v, n, s->p);
    for (int i = 0; i < n; i++) {
        hn_diff(g, s->p[i], in->v, i + 1, s->a);
        for (int j = 0; j <= i; j++) {
            M[i * n + j] = M[j * n + i] = s->a[j];
        }
        s->seed[i] = hn_graph_symbol_expr(g, in->v[i]);
    }
    hn_diff_forward(g, s->p, n, in->q, s->seed, n, s->a); // p_q v
    hn_diff_reverse(g, hn_sub(g, in->kinetic, in->potential), in->q, n, s->b);
    for (int i = 0; i < n; i++) {
        const hn_ex terms[3] = {in->force[i], hn_neg(s->a[i]), s->b[i]};
        f[i] = hn_sum(g, terms, 3);
    }
}

static void calc_constraints(hn_graph *g, const hn_lagrange_input *in, scratch *s, hn_ex *J,
                             hn_ex *phi_t, hn_ex *gamma) {
    const int n = in->n, m = in->m;
    for (int i = 0; i < n; i++) {
        s->symbols[i] = in->q[i];
        s->seed[i] = hn_graph_symbol_expr(g, in->v[i]);
    }
    for (int i = 0; i < m; i++) {
        hn_diff(g, in->constraints[i], in->q, n, J + i * n);
        hn_diff(g, in->constraints[i], &in->t, 1, phi_t + i);
    }
    // along (v, 1) twice: the rate of phi, and the rate of that at constant v
    s->symbols[n] = in->t;
    s->seed[n] = hn_num(1);
    hn_diff_forward(g, in->constraints, m, s->symbols, s->seed, n + 1, s->a);
    hn_diff_forward(g, s->a, m, s->symbols, s->seed, n + 1, gamma);
}

hn_status hn_lagrange_terms(hn_graph *g, const hn_lagrange_input *in, hn_ex *M, hn_ex *f, hn_ex *J,
                            hn_ex *phi_t, hn_ex *gamma, hn_diags *diags) {
    hn_status status = check_dependence(g, in, diags);
    if (status != HN_OK) {
        return status;
    }
    scratch s = {0};
    if (!scratch_create(&s, in)) {
        scratch_free(&s);
        return HN_ERR_MEMORY;
    }
    calc_mass_and_force(g, in, &s, M, f);
    calc_constraints(g, in, &s, J, phi_t, gamma);
    scratch_free(&s);
    if (hn_graph_failed(g)) {
        return HN_ERR_MEMORY;
    }
    return check_quadratic(g, in, M, diags);
}
