// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/budgets/budgets_store.h"

#include "session/budgets/budgets_internal.h"
#include "session/store/ending_json.h"
#include "session/store/stored_json.h"

#include "base/hash.h"

#include <math.h>
#include <stdbool.h>

enum { FORMAT = 3 }; // counts up when the meaning of a line changes

/// Hashes everything that the budgets depend on.
static uint64_t budgets_key(const hn_budgets *a) {
    const hn_scene *scene = hn_model_scene(a->model);
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &scene->hash, sizeof scene->hash);
    hash = hn_hash_double(hash, FORMAT);
    hash = hn_hash_double(hash, scene->step); // of methods that name none
    hash = hn_hash_double(hash, a->request.time);
    hash = hn_hash_double(hash, a->coordinate);
    for (int i = 0; i < a->n; i++) {
        hash = hn_hash_text(hash, a->rows[i].spelling);
    }
    return hn_hash_mix(hash);
}

/// The numbers of a budget, in the order they are written.
#define NUMBERS(X) X(t) X(error) X(sum) X(energy) X(loop_work_abs) X(swing)
#define COUNT(name) +1
enum { N_NUMBERS = 0 NUMBERS(COUNT) };
#undef COUNT

static bool take_account(const cJSON *o, int n_user, hn_budget *a) {
    double numbers[N_NUMBERS], steps;
    int state, k = 0;
    if (!hn_stored_int(o, "state", HN_RUN_FAILED + 1, &state) ||
        !hn_stored_number(o, "steps", &steps) || !(steps >= 0 && steps < 1e15) ||
        !hn_stored_int(o, "coordinate", n_user + 1, &a->coordinate) ||
        !hn_stored_int(o, "has_equations", 2, &a->has_equations) ||
        !hn_stored_int(o, "conservative", 2, &a->conservative) ||
        !hn_ending_take_json(o, &a->ending) ||
        !hn_stored_numbers(o, "numbers", numbers, N_NUMBERS) ||
        !hn_stored_numbers(o, "parts", a->part, HN_CAUSE_COUNT) ||
        !hn_stored_numbers(o, "energy_parts", a->energy_parts, HN_ENERGY_COUNT)) {
        return false;
    }
    a->coordinate--; // -1: none
    a->state = (hn_run_state)state;
    a->steps = (long long)steps;
#define TAKE(name) a->name = numbers[k++];
    NUMBERS(TAKE)
#undef TAKE
    return true;
}

static int take_line(void *user, const cJSON *o) {
    hn_budgets *a = user;
    hn_budget_row row;
    int i, status;
    if (!hn_stored_int(o, "m", a->n, &i) || !hn_stored_int(o, "status", HN_STATUS_COUNT, &status) ||
        status == HN_ERR_STOPPED) {
        return 0;
    }
    row = a->rows[i];
    row.status = (hn_status)status;
    if (!hn_stored_number(o, "holds_until", &row.holds_until) ||
        !hn_stored_text(o, "reason", row.reason, sizeof row.reason) ||
        (status == HN_OK &&
         !take_account(o, hn_system_get_info(hn_model_system(a->model)).n_user, &row.budget))) {
        return 0;
    }
    if (status != HN_OK &&
        (!hn_stored_number(o, "t", &row.budget.t) || !hn_ending_take_json(o, &row.budget.ending))) {
        return 0;
    }
    a->resumed += !a->whole[i];
    a->rows[i] = row;
    a->whole[i] = true;
    return 1;
}

hn_status hn_budgets_open_journal(hn_budgets *a, hn_diags *diags) {
    return hn_journal_open(&a->journal, a->request.limits.folder, "budget", budgets_key(a),
                           take_line, a, diags);
}

static void put_budget(hn_strbuf *b, const hn_budget *a) {
#define PUT(name) a->name,
    const double numbers[] = {NUMBERS(PUT)};
#undef PUT
    hn_json_put_int(b, "state", a->state);
    hn_json_put_int(b, "steps", a->steps);
    hn_json_put_int(b, "coordinate", a->coordinate + 1);
    hn_json_put_int(b, "has_equations", a->has_equations);
    hn_json_put_int(b, "conservative", a->conservative);
    hn_ending_put_json(b, &a->ending, a->reason, a->t);
    hn_json_put_numbers(b, "numbers", numbers, N_NUMBERS);
    hn_json_put_numbers(b, "parts", a->part, HN_CAUSE_COUNT);
    hn_json_put_numbers(b, "energy_parts", a->energy_parts, HN_ENERGY_COUNT);
}

void hn_budgets_keep(hn_budgets *a, int i) {
    const hn_budget_row *row = &a->rows[i];
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "m", i);
    hn_json_put_int(&b, "status", row->status);
    hn_json_put_string(&b, "reason", row->reason);
    hn_json_put_number(&b, "holds_until", row->holds_until);
    if (row->status == HN_OK) {
        put_budget(&b, &row->budget);
    } else {
        hn_json_put_number(&b, "t", row->budget.t);
        hn_ending_put_json(&b, &row->budget.ending, row->reason, row->budget.t);
    }
    hn_journal_write(&a->journal, &b);
}
