// The log of an unfinished map: a line a cell, a line a column's observed boundary; read up to its last whole line.
#include "session/stability_internal.h"

#include "base/hash.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { FORMAT = 1, MOST_BYTES = 64 << 20 }; // FORMAT counts up when the meaning of a line changes

static uint64_t hash_axis(uint64_t hash, const hn_map_axis *a) {
    hash = hn_hash_text(hash, a->name);
    for (int i = 0; i < a->n; i++) {
        hash = hn_hash_double(hash, a->value[i]);
    }
    return hash;
}

/// All that decides what the cells are.
static uint64_t map_key(const hn_map *map) {
    uint64_t scene = hn_model_scene(map->model)->hash;
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &scene, sizeof scene);
    hash = hn_hash_double(hash, map->T + 1000.0 * FORMAT);
    hash = hash_axis(hash_axis(hash, &map->x), &map->y);
    for (int m = 0; m < map->n_methods; m++) {
        char spelling[HN_SPEC_MAX];
        hn_method_format(&map->specs[m], spelling);
        hash = hn_hash_text(hash, spelling);
    }
    return hn_hash_mix(hash);
}

static int get_int(const cJSON *o, const char *key, int below, int *out) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(o, key);
    *out = cJSON_IsNumber(item) ? item->valueint : -1;
    return *out >= 0 && *out < below;
}

static int get_numbers(const cJSON *o, const char *key, double *out, int n) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(o, key), *item;
    if (!cJSON_IsArray(list) || cJSON_GetArraySize(list) != n) {
        return 0;
    }
    cJSON_ArrayForEach(item, list) {
        *out++ = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    }
    return 1;
}

static int get_reason(const cJSON *o, char *out) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(o, "reason"));
    return text && snprintf(out, HN_STABILITY_REASON, "%s", text) < HN_STABILITY_REASON;
}

static int take_cell(hn_map *map, const cJSON *o, int m, int column, int row) {
    hn_stability_trial t = {0};
    double numbers[5];
    int kind, status;
    if (!get_int(o, "kind", HN_STABILITY_CLASS_COUNT, &kind) ||
        !get_int(o, "status", HN_STATUS_COUNT, &status) || !get_numbers(o, "numbers", numbers, 5) ||
        !get_reason(o, t.reason)) {
        return 0;
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
    return 1;
}

static int take_line(hn_map *map, const char *line) {
    cJSON *o = cJSON_Parse(line);
    int m, column, row;
    double between[2];
    int ok = get_int(o, "m", map->n_methods, &m) && get_int(o, "column", map->x.n, &column);
    if (ok && cJSON_HasObjectItem(o, "row")) {
        ok = get_int(o, "row", map->y.n, &row) && take_cell(map, o, m, column, row);
    } else if (ok) {
        hn_map_column *c = hn_map_column_at(map, m, column);
        ok = get_numbers(o, "between", between, 2) && get_reason(o, c->how);
        c->stable = ok ? between[0] : (double)NAN;
        c->unstable = ok ? between[1] : (double)NAN;
    }
    cJSON_Delete(o);
    return ok;
}

static char *read_all(FILE *f) {
    if (fseek(f, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long size = ftell(f);
    rewind(f);
    char *text = size >= 0 && size <= MOST_BYTES ? malloc((size_t)size + 1) : NULL;
    if (text) {
        text[fread(text, 1, (size_t)size, f)] = 0;
    }
    return text;
}

/// Reads whole lines into the map; returns the bytes they take.
static size_t take_lines(hn_map *map, char *text) {
    size_t used = 0;
    for (char *end; (end = strchr(text + used, '\n')) != NULL;) {
        *end = 0;
        if (!take_line(map, text + used)) {
            break;
        }
        used = (size_t)(end - text) + 1;
    }
    return used;
}

hn_status hn_map_open_log(hn_map *map, hn_diags *diags) {
    char hex[17];
    hn_hash_hex(map_key(map), hex);
    if (snprintf(map->log_path, sizeof map->log_path, "%s/stability-%s.ndjson", map->request.folder,
                 hex) >= (int)sizeof map->log_path) {
        return HN_OK; // nowhere to keep it
    }
    map->log = fopen(map->log_path, "a+b");
    if (!map->log) {
        return hn_diags_add(diags, HN_ERR_IO, NULL, NULL, "cannot keep the map in '%.200s': %s",
                            map->log_path, strerror(errno));
    }
    if (flock(fileno(map->log), LOCK_EX | LOCK_NB) != 0) {
        fclose(map->log);
        map->log = NULL;
        return hn_diags_add(diags, HN_ERR_IO, NULL, "wait for it, or change the grid",
                            "another program is at this very map");
    }
    char *text = read_all(map->log);
    const size_t used = text ? take_lines(map, text) : 0;
    free(text);
    map->log_failed = ftruncate(fileno(map->log), (off_t)used) != 0;
    return HN_OK;
}

void hn_map_close_log(hn_map *map, int finished) {
    if (map->log) {
        if (finished) {
            remove(map->log_path);
        }
        fclose(map->log);
        map->log = NULL;
    }
}

static void write_line(hn_map *map, hn_strbuf *b) {
    hn_json_end_object(b);
    hn_strbuf_add(b, "\n");
    if (!map->log_failed) {
        map->log_failed = b->failed || fwrite(hn_strbuf_text(b), 1, b->n, map->log) != b->n ||
                          fflush(map->log) != 0;
    }
    hn_strbuf_reset(b);
}

static void begin_line(hn_strbuf *b, int m, int column) {
    hn_strbuf_init(b);
    hn_json_object(b);
    hn_json_put_int(b, "m", m);
    hn_json_put_int(b, "column", column);
}

void hn_map_log_cell(hn_map *map, int m, int column, int row) {
    const hn_stability_trial *t = &hn_map_cell_at(map, m, column, row)->trial;
    const double numbers[5] = {t->t_reached, t->error, t->energy, t->gap, (double)t->steps};
    hn_strbuf b;
    if (map->log) {
        begin_line(&b, m, column);
        hn_json_put_int(&b, "row", row);
        hn_json_put_int(&b, "kind", t->kind);
        hn_json_put_int(&b, "status", t->status);
        hn_json_put_string(&b, "reason", t->reason);
        hn_json_put_numbers(&b, "numbers", numbers, 5);
        write_line(map, &b);
    }
}

void hn_map_log_column(hn_map *map, int m, int column) {
    const hn_map_column *c = hn_map_column_at(map, m, column);
    const double between[2] = {c->stable, c->unstable};
    hn_strbuf b;
    if (map->log) {
        begin_line(&b, m, column);
        hn_json_put_string(&b, "reason", c->how);
        hn_json_put_numbers(&b, "between", between, 2);
        write_line(map, &b);
    }
}
