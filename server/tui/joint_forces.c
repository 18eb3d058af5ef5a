// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/joint_forces.h"

#include "base/arena.h"
#include "dynamics/compile/coordinates.h"
#include "study/run/run.h"

#include <stdlib.h>

static hn_status make(hn_joint_forces *f, const hn_library *library, const hn_model_source *source,
                      hn_diags *diags) {
    HN_TRY(hn_model_load(library, source, &f->model, diags));
    const hn_system *sys = hn_model_system(f->model);
    const hn_system_info info = hn_system_get_info(sys);
    f->arena = hn_arena_create(0);
    if (!f->arena) {
        return HN_ERR_MEMORY;
    }
    f->q = hn_arena_doubles(f->arena, (size_t)info.nq + 1);
    f->v = hn_arena_doubles(f->arena, (size_t)info.nv + 1);
    f->a = hn_arena_doubles(f->arena, (size_t)info.nv + 1);
    f->lambda = hn_arena_doubles(f->arena, (size_t)info.nc + 1);
    if (hn_arena_failed(f->arena)) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_accel_create(sys, &(hn_accel_opts){.want_lambda = 1}, f->arena, &f->accel));
    return hn_reaction_writer_create(f->model, f->arena, &f->writer, diags);
}

hn_status hn_joint_forces_create(const hn_library *library, const hn_model_source *source,
                                 hn_joint_forces **out, hn_diags *diags) {
    hn_joint_forces *f = calloc(1, sizeof *f);
    const hn_status status = f ? make(f, library, source, diags) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        hn_joint_forces_free(f);
        f = NULL;
    }
    *out = f;
    return status;
}

void hn_joint_forces_free(hn_joint_forces *f) {
    if (f) {
        hn_reaction_writer_free(f->writer);
        hn_accel_free(f->accel);
        hn_arena_free(f->arena);
        hn_model_free(f->model);
        cJSON_Delete(f->document);
        free(f);
    }
}

/// Multipliers of a loop that stands open are those of another mechanism.
static hn_multiplier_mark mark_of(const hn_joint_forces *f, double t, double gap,
                                  const hn_accel_info *info) {
    const hn_multiplier_mark mark = hn_accel_mark(f->accel, t, f->q, f->v, info);
    const bool counts = mark == HN_MULTIPLIERS_DETERMINED || mark == HN_MULTIPLIERS_ONE_OF_MANY;
    const bool open = gap > HN_RUN_WARN_GAP * hn_system_length(hn_model_system(f->model));
    return counts && open ? HN_MULTIPLIERS_OPEN : mark;
}

void hn_joint_forces_calc(hn_joint_forces *f, double t, const double *q, const double *v,
                          double gap) {
    const hn_system *sys = hn_model_system(f->model);
    hn_accel_info info = {0};
    hn_strbuf b;
    if (f->at == q) {
        return;
    }
    f->at = q;
    hn_system_from_user(sys, q, f->q);
    hn_system_rates_from_user(sys, v, f->v);
    f->status = hn_accel_eval(f->accel, t, f->q, f->v, 0, 0, f->a, f->lambda, &info);
    f->mark = f->status == HN_OK ? mark_of(f, t, gap, &info) : HN_MULTIPLIERS_NONE;
    HN_THEN(f->status, hn_reaction_writer_eval(f->writer, t, f->q, f->v));

    // forces and efforts as a document has them
    cJSON_Delete(f->document);
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_reaction_writer_put(&b, f->writer);
    hn_json_end_object(&b);
    f->document = cJSON_Parse(hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}
