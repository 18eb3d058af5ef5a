// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/native_costs.h"

#include "dynamics/evaluate/accel.h"

static hn_status measure(const hn_system *sys, hn_native_costs *costs, hn_diag *diag) {
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_accel *accel = NULL;
    hn_arena *arena = hn_arena_create(0);
    hn_status status = arena ? hn_accel_create(sys, &opts, arena, &accel) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = hn_accel_measure_native(accel, costs, diag);
    } else {
        hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    }
    hn_accel_free(accel);
    hn_arena_free(arena);
    return status;
}

void hn_model_native_put(hn_strbuf *b, const hn_model *model) {
    hn_native_costs costs;
    hn_diag diag = {0};
    const hn_status status = measure(hn_model_system(model), &costs, &diag);
    hn_json_object(b);
    hn_json_put_string(b, "status", status == HN_OK ? "compiled" : diag.message);
    if (status == HN_OK) {
        hn_json_put_int(b, "instructions", costs.instructions);
        hn_json_put_number(b, "emit_seconds", costs.emit_seconds);
        hn_json_put_number(b, "compile_seconds", costs.compile_seconds);
        hn_json_put_number(b, "load_seconds", costs.load_seconds);
        hn_json_put_number(b, "interpreter_ns", costs.interpreter_ns);
        hn_json_put_number(b, "native_ns", costs.native_ns);
        hn_json_put_number(b, "break_even_evaluations", costs.break_even);
    }
    hn_json_end_object(b);
}
