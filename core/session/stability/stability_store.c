// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_store.h"

#include "session/stability/map_grid.h"
#include "session/stability/stability_internal.h"
#include "session/store/stored_json.h"

#include "base/hash.h"

#include <stdbool.h>

enum { FORMAT = 2 };                   // counts up when the meaning of a line changes
static const double MOST_STEPS = 9e15; // whole numbers are exact up to here

static uint64_t hash_axis(uint64_t hash, const hn_map_axis *a) {
    hash = hn_hash_text(hash, a->name);
    for (int i = 0; i < a->n; i++) {
        hash = hn_hash_double(hash, a->value[i]);
    }
    return hash;
}

/// Hashes everything that the outcomes of the cells depend on.
static uint64_t map_key(const hn_map *map) {
    uint64_t scene = hn_model_scene(map->model)->hash;
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &scene, sizeof scene);
    hash = hn_hash_double(hash, map->T + 1000.0 * FORMAT);
    hash = hn_hash_double(hash, hn_model_scene(map->model)->step); // of methods that name none
    hash = hash_axis(hash_axis(hash, &map->x), &map->y);
    for (int m = 0; m < map->n_methods; m++) {
        char spelling[HN_SPEC_MAX];
        hn_method_format(&map->specs[m], spelling);
        hash = hn_hash_text(hash, spelling);
    }
    return hn_hash_mix(hash);
}

static bool take_cell(hn_map *map, const cJSON *o, int m, int column, int row) {
    hn_stability_trial t = {0};
    double numbers[5];
    int kind, status;
    if (!hn_stored_int(o, "kind", HN_STABILITY_CLASS_COUNT, &kind) ||
        !hn_stored_int(o, "status", HN_STATUS_COUNT, &status) ||
        !hn_stored_numbers(o, "numbers", numbers, 5) ||
        !(numbers[4] >= 0 && numbers[4] <= MOST_STEPS) ||
        !hn_stored_text(o, "reason", t.reason, sizeof t.reason)) {
        return false;
    }
    t.kind = (hn_stability_class)kind;
    t.status = (hn_status)status;
    t.t_reached = numbers[0];
    t.error = numbers[1];
    t.energy = numbers[2];
    t.gap = numbers[3];
    t.steps = (long long)numbers[4];
    hn_map_cell_at(map, m, column, row)->trial = t;
    map->resumed++;
    return true;
}

static bool take_column(hn_map_column *c, const cJSON *o) {
    double between[2];
    if (!hn_stored_numbers(o, "between", between, 2) ||
        !hn_stored_text(o, "reason", c->how, sizeof c->how)) {
        return false;
    }
    c->stable = between[0];
    c->unstable = between[1];
    return true;
}

static int take_line(void *user, const cJSON *o) {
    hn_map *map = user;
    int m, column, row;
    if (!hn_stored_int(o, "m", map->n_methods, &m) ||
        !hn_stored_int(o, "column", map->x.n, &column)) {
        return 0;
    }
    if (cJSON_HasObjectItem(o, "accurate")) {
        return hn_stored_numbers(o, "accurate", &hn_map_column_at(map, m, column)->accurate, 1);
    }
    if (!cJSON_HasObjectItem(o, "row")) {
        return take_column(hn_map_column_at(map, m, column), o);
    }
    return hn_stored_int(o, "row", map->y.n, &row) && take_cell(map, o, m, column, row);
}

hn_status hn_map_open_journal(hn_map *map, hn_diags *diags) {
    return hn_journal_open(&map->journal, map->request.limits.folder, "stability", map_key(map),
                           take_line, map, diags);
}

static void begin_line(hn_strbuf *b, int m, int column) {
    hn_strbuf_init(b);
    hn_json_object(b);
    hn_json_put_int(b, "m", m);
    hn_json_put_int(b, "column", column);
}

void hn_map_keep_cell(hn_map *map, int m, int column, int row) {
    const hn_stability_trial *t = &hn_map_cell_at(map, m, column, row)->trial;
    const double numbers[5] = {t->t_reached, t->error, t->energy, t->gap, (double)t->steps};
    hn_strbuf b;
    begin_line(&b, m, column);
    hn_json_put_int(&b, "row", row);
    hn_json_put_int(&b, "kind", t->kind);
    hn_json_put_int(&b, "status", t->status);
    hn_json_put_string(&b, "reason", t->reason);
    hn_json_put_numbers(&b, "numbers", numbers, 5);
    hn_journal_write(&map->journal, &b);
}

void hn_map_keep_column(hn_map *map, int m, int column) {
    const hn_map_column *c = hn_map_column_at(map, m, column);
    const double between[2] = {c->stable, c->unstable};
    hn_strbuf b;
    begin_line(&b, m, column);
    hn_json_put_string(&b, "reason", c->how);
    hn_json_put_numbers(&b, "between", between, 2);
    hn_journal_write(&map->journal, &b);
}

void hn_map_keep_accuracy(hn_map *map, int m) {
    hn_strbuf b;
    begin_line(&b, m, 0);
    hn_json_put_numbers(&b, "accurate", &hn_map_column_at(map, m, 0)->accurate, 1);
    hn_journal_write(&map->journal, &b);
}
