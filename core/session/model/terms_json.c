// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/terms_json.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "session/model/model.h"
#include "session/model/reactions_json.h"
#include "session/model/reduced_json.h"
#include "session/model/state.h"
#include "session/store/columns_json.h"
#include "study/incidents/watch.h"

#include <math.h>
#include <string.h>

enum {
    MAX_DENSE = 150,
    MAX_K = 40
}; ///< largest number of velocities for the matrices; largest size of K

/// Workspace of one call. P (nv x n): v_system = P v_user.
typedef struct terms {
    const hn_model *model;
    hn_system_info info;
    hn_arena *arena;
    hn_eval *eval;
    hn_accel *accel;
    double t, *uq, *uv, *q, *v, *P, *M, *J, *f, *a, *ua, *lambda, *scratch;
    hn_accel_info accel_info;
    hn_status accel_status;
    hn_reaction_writer *reactions; ///< NULL: not asked for
} terms;

static hn_status create(terms *w, const hn_model *model, hn_diags *diags) {
    *w = (terms){.model = model, .info = hn_system_get_info(hn_model_system(model))};
    if (w->info.nv > MAX_DENSE) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/scene", "inspect reports its sizes and patterns",
                            "the scene has %d speeds; its matrices are written out up to %d",
                            w->info.nv, MAX_DENSE);
    }

    // workspace, sized by coordinates of the system and of the scene
    size_t n = (size_t)w->info.nv, m = (size_t)w->info.nc, nq = (size_t)w->info.nq,
           nu = (size_t)w->info.n_user;
    w->arena = hn_arena_create(0);
    if (!w->arena) {
        return HN_ERR_MEMORY;
    }
    double **const places[] = {&w->uq, &w->uv, &w->q, &w->v,  &w->P,      &w->M,
                               &w->J,  &w->f,  &w->a, &w->ua, &w->lambda, &w->scratch};
    const size_t sizes[] = {nu, nu, nq, n, n * nu, nu * nu, m * nu, nu, n, nu, m, n * nu + m};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        *places[i] = hn_arena_doubles(w->arena, sizes[i] + 1);
    }
    if (hn_arena_failed(w->arena)) {
        return HN_ERR_MEMORY;
    }

    // evaluators of the terms and of the accelerations
    unsigned all = HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_GAMMA |
                   HN_TERM_ENERGY;
    HN_TRY(hn_eval_create(hn_model_system(model), all, w->arena, &w->eval));
    return hn_accel_create(hn_model_system(model), &(hn_accel_opts){.want_lambda = 1}, w->arena,
                           &w->accel);
}

static void destroy(terms *w) {
    hn_eval_free(w->eval);
    hn_accel_free(w->accel);
    hn_reaction_writer_free(w->reactions);
    hn_arena_free(w->arena);
}

/// out (rows x nu) = A (rows x nv) P
static void times_P(const terms *w, const double *A, int rows, double *out) {
    int n = w->info.nv, nu = w->info.n_user;
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < nu; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) {
                sum += A[i * n + k] * w->P[k * nu + j];
            }
            out[i * nu + j] = sum;
        }
    }
}

/// M, J, f in the scene's coordinates: P' M P, J P, P' f; accelerations by the same map as rates.
static void calc_user_terms(terms *w) {
    const hn_system *sys = hn_model_system(w->model);
    int n = w->info.nv, nu = w->info.n_user;

    // columns of P: images of the unit rates
    for (int j = 0; j < nu; j++) {
        memset(w->ua, 0, (size_t)nu * sizeof(double));
        w->ua[j] = 1;
        hn_system_rates_from_user(sys, w->ua, w->a);
        for (int k = 0; k < n; k++) {
            w->P[k * nu + j] = w->a[k];
        }
    }

    // J P and P' M P
    hn_eval_run(w->eval, w->t, w->q, w->v);
    times_P(w, hn_eval_get(w->eval, HN_TERM_J), w->info.nc, w->J);
    times_P(w, hn_eval_get(w->eval, HN_TERM_M), n, w->scratch);
    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nu; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) {
                sum += w->P[k * nu + i] * w->scratch[k * nu + j];
            }
            w->M[i * nu + j] = sum;
        }
    }

    // P' f, and the accelerations in the scene's rates
    hn_system_forces_to_user(sys, hn_eval_get(w->eval, HN_TERM_F), w->f);
    w->accel_status =
        hn_accel_eval(w->accel, w->t, w->q, w->v, 0, 0, w->a, w->lambda, &w->accel_info);
    if (w->accel_status == HN_OK) {
        hn_system_rates_to_user(sys, w->a, w->ua);
    }
}

/// K = [M J'; J 0], the matrix of K [a; -lambda] = [f; -gamma].
static void put_saddle(hn_strbuf *b, const terms *w) {
    int nu = w->info.n_user, m = w->info.nc, n = nu + m;
    double row[MAX_K];
    if (n > MAX_K) {
        return;
    }
    hn_json_key(b, "K");
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            row[j] = i < nu && j < nu ? w->M[i * nu + j]
                     : i < nu         ? w->J[(j - nu) * nu + i]
                     : j < nu         ? w->J[(i - nu) * nu + j]
                                      : 0;
        }
        hn_json_numbers(b, row, (size_t)n);
    }
    hn_json_end_array(b);
}

static double velocity_gap(const terms *w) {
    const double *J = hn_eval_get(w->eval, HN_TERM_J), *phi_t = hn_eval_get(w->eval, HN_TERM_PHI_T);
    double sum = 0;
    for (int i = 0; i < w->info.nc; i++) {
        double row = phi_t[i];
        for (int k = 0; k < w->info.nv; k++) {
            row += J[i * w->info.nv + k] * w->v[k];
        }
        sum = hypot(sum, row);
    }
    return sum;
}

/// 1-norm condition of the equilibrated K, and the decimal digits it leaves.
static void put_condition(hn_strbuf *b, const terms *w) {
    double kappa = 0;
    if (hn_accel_condition(w->accel, w->t, w->q, w->v, &kappa) == HN_OK && kappa > 0) {
        hn_json_put_number(b, "condition", kappa);
        hn_json_put_number(b, "digits_left", fmax(0, 15.6 - log10(kappa)));
    }
}

/// Returns whether the loops of the state stand open by more than a run reports.
static bool is_open(const terms *w) {
    const double gap = hn_norm2(w->info.nc, hn_eval_get(w->eval, HN_TERM_PHI));
    return gap > HN_RUN_WARN_GAP * hn_system_length(hn_model_system(w->model));
}

static void put_mark(hn_strbuf *b, const terms *w) {
    if (w->info.nc > 0) {
        hn_multiplier_mark mark = hn_accel_mark(w->accel, w->t, w->q, w->v, &w->accel_info);
        const bool counts = mark == HN_MULTIPLIERS_DETERMINED || mark == HN_MULTIPLIERS_ONE_OF_MANY;
        mark = counts && is_open(w) ? HN_MULTIPLIERS_OPEN : mark;
        hn_json_put_string(b, "lambda_mark", hn_multiplier_marks[mark]);
    }
}

static void put_solution(hn_strbuf *b, const terms *w) {
    hn_json_put_string(b, "status", hn_status_name(w->accel_status));
    if (w->accel_status == HN_OK) {
        hn_json_put_numbers(b, "a", w->ua, (size_t)w->info.n_user);
        hn_json_put_numbers(b, "lambda", w->lambda, (size_t)w->info.nc);
        put_mark(b, w);
        hn_json_put_int(b, "rank", w->accel_info.rank);
        hn_json_put_number(b, "pivot_ratio", w->accel_info.pivot_ratio);
        hn_json_put_number(b, "row_ratio", w->accel_info.row_ratio);
        hn_json_put_bool(b, "dense_fallback", w->accel_info.fallback);
        hn_json_put_string(b, "solver", hn_solver_names[w->accel_info.solver]);
        hn_json_put_int(b, "refinements", w->accel_info.refinements);
        put_condition(b, w);
    } else {
        hn_json_put_string(b, "reason", hn_status_text(w->accel_status));
    }
}

static hn_status put_terms(hn_strbuf *b, const terms *w) {
    int nu = w->info.n_user, m = w->info.nc;
    const double *energy = hn_eval_get(w->eval, HN_TERM_ENERGY),
                 *phi = hn_eval_get(w->eval, HN_TERM_PHI);

    // names of coordinates and rows
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(w->model)->id);
    hn_json_put_string(b, "equations", "M a = f + J' lambda, J a + gamma = 0, f = Q - h");
    hn_columns_put_coordinates(b, hn_model_system(w->model));
    hn_columns_put_rates(b, hn_model_system(w->model));
    hn_columns_put_rows(b, hn_model_system(w->model));

    // state, terms and constraint values
    hn_json_put_number(b, "t", w->t);
    hn_json_put_numbers(b, "q", w->uq, (size_t)nu);
    hn_json_put_numbers(b, "v", w->uv, (size_t)nu);
    hn_columns_put_table(b, "M", w->M, nu, nu);
    hn_json_put_numbers(b, "f", w->f, (size_t)nu);
    hn_columns_put_table(b, "J", w->J, m, nu);
    hn_json_put_numbers(b, "gamma", hn_eval_get(w->eval, HN_TERM_GAMMA), (size_t)m);
    hn_json_put_numbers(b, "phi", phi, (size_t)m);

    // solution: accelerations, multipliers, reactions
    put_saddle(b, w);
    put_solution(b, w);
    if (w->reactions) {
        hn_reaction_writer_put(b, w->reactions);
    }

    // reduced equations, then scalars
    const hn_status status = hn_reduced_put(b, w->model, w->arena, w->t, w->q, w->v);
    hn_json_put_number(b, "gap", hn_norm2(m, phi));
    hn_json_put_number(b, "velocity_gap", velocity_gap(w));
    hn_json_put_number(b, "kinetic", energy[0]);
    hn_json_put_number(b, "potential", energy[1]);
    hn_json_end_object(b);
    return status;
}

static hn_status write_terms(hn_strbuf *b, const hn_model *model, double t,
                             const hn_state_entry *entries, int n_entries, int reactions,
                             hn_diags *diags) {
    terms w;
    hn_status status = create(&w, model, diags);
    if (status == HN_OK && reactions) {
        status = hn_reaction_writer_create(model, w.arena, &w.reactions, diags);
    }
    if (status == HN_OK && !isfinite(t)) {
        status = hn_diags_add(diags, HN_ERR_INPUT, "/t", NULL, "the time is not a finite number");
    }

    // the state, in coordinates of the system and of the scene
    if (status == HN_OK) {
        w.t = t;
        status = hn_model_state(model, entries, n_entries, w.q, w.v, diags);
        hn_system_to_user(hn_model_system(model), w.q, w.uq);
        hn_system_rates_to_user(hn_model_system(model), w.v, w.uv);
    }
    if (status == HN_OK) {
        calc_user_terms(&w);
        // reactions need accelerations: without them the list is empty and "status" gives the
        // reason
        if (w.reactions && w.accel_status == HN_OK) {
            w.accel_status = hn_reaction_writer_eval(w.reactions, t, w.q, w.v);
        }
        status = put_terms(b, &w);
    }
    destroy(&w);
    return status;
}

hn_status hn_model_terms_json(hn_strbuf *b, const hn_model *model, double t,
                              const hn_state_entry *entries, int n_entries, hn_diags *diags) {
    return write_terms(b, model, t, entries, n_entries, 0, diags);
}

hn_status hn_model_terms_json_with_reactions(hn_strbuf *b, const hn_model *model, double t,
                                             const hn_state_entry *entries, int n_entries,
                                             hn_diags *diags) {
    return write_terms(b, model, t, entries, n_entries, 1, diags);
}
