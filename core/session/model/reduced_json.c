// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/reduced_json.h"

#include "formulations/chart/reduced_terms.h"
#include "linalg/dense.h"
#include "session/store/columns_json.h"

#define SPEED_TOL 1e-9 // of the largest velocity: violations below this are rounding

static const hn_coordinate *coordinate_of(const hn_model *model, int user) {
    return &hn_model_scene(model)
                ->coordinates[hn_system_user_coordinate(hn_model_system(model), user)];
}

static void put_names(hn_strbuf *b, const hn_model *model, const hn_reduced_terms *w) {
    hn_json_key(b, "independent");
    hn_json_array(b);
    for (int j = 0; j < w->r; j++) {
        hn_json_string(b, coordinate_of(model, w->ind[j])->name);
    }
    hn_json_end_array(b);
    hn_json_key(b, "rates");
    hn_json_array(b);
    for (int j = 0; j < w->r; j++) {
        hn_json_string(b, coordinate_of(model, w->ind[j])->rate);
    }
    hn_json_end_array(b);
    hn_json_put_string(b, "chosen_by", hn_reduced_choice_text(w->choice));
}

static void put_terms(hn_strbuf *b, const hn_model *model, const hn_reduced_terms *w) {
    const size_t r = (size_t)w->r;

    // the equation, and the coordinates it is written in
    hn_json_put_bool(b, "exists", 1);
    hn_json_put_string(b, "equations",
                       w->is_moved ? "v = Phi v_r + s, M_r a_r + C_r v_r + d_r + g_r = tau_r"
                                   : "v = Phi v_r, M_r a_r + C_r v_r + g_r = tau_r");
    put_names(b, model, w);

    // matrices and vectors
    hn_json_put_numbers(b, "v_r", w->v_r, r);
    hn_columns_put_table(b, "Phi", w->Phi, w->nv, w->r);
    hn_columns_put_table(b, "M_r", w->M_r, w->r, w->r);
    hn_columns_put_table(b, "C_r", w->C_r, w->r, w->r);
    hn_json_put_numbers(b, "g_r", w->g_r, r);
    hn_json_put_numbers(b, "tau_r", w->tau_r, r);

    // terms of constraints that depend on time
    if (w->is_moved) {
        hn_json_put_numbers(b, "s", w->s, (size_t)w->nv);
        hn_json_put_numbers(b, "d_r", w->d_r, r);
    }

    // solution, and by how much v violates the constraints
    hn_json_put_numbers(b, "a_r", w->a_r, r);
    if (w->speed_gap > SPEED_TOL * (1 + hn_norm_max(w->r, w->v_r))) {
        hn_json_put_number(b, "speed_gap", w->speed_gap);
    }
}

hn_status hn_reduced_put(hn_strbuf *b, const hn_model *model, hn_arena *arena, double t,
                         const double *q, const double *v) {
    hn_reduced_terms w;
    hn_status status = hn_reduced_terms_init(&w, hn_model_system(model), arena, NULL);
    if (status != HN_OK) {
        hn_reduced_terms_destroy(&w);
        return status;
    }

    // without a chart the object says why
    hn_json_key(b, "reduced");
    hn_json_object(b);
    status = hn_reduced_terms_eval(&w, t, q, v, hn_model_assembly(model)->freedoms);
    if (status == HN_OK) {
        put_terms(b, model, &w);
    } else {
        const char *why = hn_reduced_terms_why(&w);
        hn_json_put_bool(b, "exists", 0);
        hn_json_put_string(b, "why", why ? why : hn_status_text(status));
    }
    hn_json_end_object(b);
    hn_reduced_terms_destroy(&w);
    return HN_OK;
}
