// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/reference.h"

#include "support/near.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 32 };
static const char *const KIND[HN_REFERENCE_KINDS] = {"q", "v", "a", "lambda"};

struct hn_reference {
    cJSON *file;
    char name[64];
    double scale[HN_REFERENCE_KINDS][HN_REFERENCE_MAX];
};

/// A state to compare with: a trusted one, which the method has to meet to digits of its own, or a
/// published one, with digits that it is known to have.
typedef struct row {
    double t;
    const cJSON *state, *digits;
} row;

// ---- the file ----

static char *read_all(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        fail_msg("no file %s", path);
    }
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    long size = ftell(file);
    assert_true(size > 0);
    rewind(file);
    char *text = calloc((size_t)size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, file), size);
    assert_int_equal(fclose(file), 0);
    return text;
}

static const cJSON *need(const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item) {
        fail_msg("the reference has no '%s'", key);
    }
    return item;
}

/// Numbers stand in the file as decimal digits in quotes, since they have more of them than a
/// double.
static double number(const cJSON *item) {
    char *end = NULL;
    assert_true(cJSON_IsString(item));
    double value = strtod(item->valuestring, &end);
    assert_true(end && *end == '\0' && isfinite(value));
    return value;
}

static void find_scales(hn_reference *r) {
    const cJSON *state, *x;
    cJSON_ArrayForEach(state, need(r->file, "states")) {
        for (int k = 0; k < HN_REFERENCE_KINDS; k++) {
            int i = 0;
            cJSON_ArrayForEach(x, cJSON_GetObjectItemCaseSensitive(state, KIND[k])) {
                assert_true(i < HN_REFERENCE_MAX);
                r->scale[k][i] = fmax(r->scale[k][i], fabs(number(x)));
                i++;
            }
        }
    }
}

hn_reference *hn_reference_open(const char *name) {
    char path[256];
    hn_reference *r = calloc(1, sizeof *r);
    assert_non_null(r);
    (void)snprintf(path, sizeof path, "tests/reference/states/%s.json", name);
    (void)snprintf(r->name, sizeof r->name, "%s", name);
    char *text = read_all(path);
    r->file = cJSON_Parse(text);
    free(text);
    if (!r->file) {
        fail_msg("%s is not JSON", path);
    }
    find_scales(r);
    return r;
}

void hn_reference_close(hn_reference *r) {
    cJSON_Delete(r->file);
    free(r);
}

int hn_reference_scenes(const hn_reference *r) {
    return cJSON_GetArraySize(need(r->file, "scenes"));
}

const char *hn_reference_scene(const hn_reference *r, int i) {
    return cJSON_GetArrayItem(need(r->file, "scenes"), i)->valuestring;
}

int hn_reference_methods(const hn_reference *r) {
    return cJSON_GetArraySize(need(r->file, "methods"));
}

static const cJSON *method_entry(const hn_reference *r, int i) {
    return cJSON_GetArrayItem(need(r->file, "methods"), i);
}

const char *hn_reference_method(const hn_reference *r, int i) {
    return need(method_entry(r, i), "method")->valuestring;
}

// ---- states ----

static const cJSON *trusted_at(const hn_reference *r, double t) {
    const cJSON *state;
    cJSON_ArrayForEach(state, need(r->file, "states")) {
        if (need(state, "t")->valuedouble == t) {
            return state;
        }
    }
    fail_msg("%s has no trusted state at t = %g", r->name, t);
    return NULL;
}

hn_reference_state hn_reference_trusted(const hn_reference *r, double t) {
    hn_reference_state s = {0};
    const cJSON *state = trusted_at(r, t), *x;
    for (int k = 0; k < HN_REFERENCE_KINDS; k++) {
        cJSON_ArrayForEach(x, cJSON_GetObjectItemCaseSensitive(state, KIND[k])) {
            s.x[k][s.n[k]++] = number(x);
        }
    }
    return s;
}

/// Each coordinate of the reference is an offset and a sum of factors times coordinates of the
/// scene.
static hn_reference_state convert(const hn_reference *r, const hn_model *m, const hn_sample *s) {
    hn_reference_state out = {0};
    const cJSON *c, *part;
    const double *from[] = {s->q, s->v, s->a};
    double sign = need(r->file, "lambda_factor")->valuedouble;
    int i = 0;
    cJSON_ArrayForEach(c, need(r->file, "coordinates")) {
        const cJSON *offset = cJSON_GetObjectItemCaseSensitive(c, "offset");
        assert_true(i < HN_REFERENCE_MAX);
        out.x[HN_REFERENCE_Q][i] = offset ? number(offset) : 0;
        cJSON_ArrayForEach(part, need(c, "of")) {
            int user = hn_model_user(m, part->string);
            for (int k = HN_REFERENCE_Q; k <= HN_REFERENCE_A; k++) {
                out.x[k][i] += part->valuedouble * from[k][user];
            }
        }
        i++;
    }
    out.n[HN_REFERENCE_Q] = out.n[HN_REFERENCE_V] = out.n[HN_REFERENCE_A] = i;
    assert_true(m->info.nc <= HN_REFERENCE_MAX);
    out.n[HN_REFERENCE_LAMBDA] = m->info.nc;
    for (int j = 0; j < m->info.nc; j++) {
        out.x[HN_REFERENCE_LAMBDA][j] = sign * s->lambda[j];
    }
    return out;
}

/// -1 where the reference has nothing of this kind. A component that was not published is null
/// there.
static double agreement(const hn_reference *r, hn_reference_kind kind, const cJSON *state,
                        const hn_reference_state *found) {
    const cJSON *values = cJSON_GetObjectItemCaseSensitive(state, KIND[kind]), *x;
    double digits = 16;
    int i = 0;
    if (!values) {
        return -1;
    }
    assert_int_equal(cJSON_GetArraySize(values), found->n[kind]);
    cJSON_ArrayForEach(x, values) {
        double scale = r->scale[kind][i] > 0 ? r->scale[kind][i] : 1;
        if (!cJSON_IsNull(x)) {
            double error = fabs(found->x[kind][i] - number(x)) / scale;
            digits = isfinite(error) ? fmin(digits, -log10(fmax(error, 1e-16))) : -HUGE_VAL;
        }
        i++;
    }
    return digits;
}

double hn_reference_digits(const hn_reference *r, hn_reference_kind kind, double t,
                           const hn_reference_state *found) {
    return agreement(r, kind, trusted_at(r, t), found);
}

// ---- runs ----

static void open_scene(const hn_reference *r, const char *scene, hn_model *m) {
    const cJSON *set = cJSON_GetObjectItemCaseSensitive(r->file, "set");
    hn_model_open_closed(m, scene, set ? set->valuestring : NULL);
}

hn_reference_state hn_reference_run_to(const hn_reference *r, const char *scene, const char *method,
                                       double t) {
    hn_model m;
    open_scene(r, scene, &m);
    hn_run *run = hn_motion_start(&m, method);
    hn_sample s = hn_motion_at(run, t);
    hn_reference_state state = convert(r, &m, &s);
    hn_run_free(run);
    hn_model_close(&m);
    return state;
}

static int by_time(const void *a, const void *b) {
    double ta = ((const row *)a)->t, tb = ((const row *)b)->t;
    return (ta > tb) - (ta < tb);
}

static int list_rows(const hn_reference *r, const cJSON *entry, row rows[MAX_ROWS]) {
    const cJSON *state;
    int n = 0;
    cJSON_ArrayForEach(state, need(r->file, "states")) {
        assert_true(n < MAX_ROWS);
        rows[n++] = (row){need(state, "t")->valuedouble, state, need(entry, "digits")};
    }
    cJSON_ArrayForEach(state, need(r->file, "published")) {
        assert_true(n < MAX_ROWS);
        rows[n++] = (row){need(state, "t")->valuedouble, state, need(state, "digits")};
    }
    qsort(rows, (size_t)n, sizeof *rows, by_time);
    return n;
}

static void must_agree(const hn_reference *r, const char *where, const row *at,
                       const hn_reference_state *found) {
    for (int k = 0; k < HN_REFERENCE_KINDS; k++) {
        double digits = agreement(r, (hn_reference_kind)k, at->state, found);
        if (digits == -1) {
            continue;
        }
        double wanted = need(at->digits, KIND[k])->valuedouble;
        assert_true(wanted > 2); // a demand that means something
        if (!(digits >= wanted)) {
            fail_msg("%s, %s at t = %g: %s agrees to %.2f digits, asked for are %.2f", r->name,
                     where, at->t, KIND[k], digits, wanted);
        }
    }
}

static void must_stop(const hn_reference *r, const char *scene, const cJSON *entry) {
    hn_model m;
    open_scene(r, scene, &m);
    hn_run *run = hn_motion_start(&m, need(entry, "method")->valuestring);
    hn_status status = hn_run_advance(run, m.scene->duration);
    assert_string_equal(hn_status_name(status), need(entry, "stops")->valuestring);
    assert_string_not_equal(hn_run_get_summary(run).reason, "");
    hn_run_free(run);
    hn_model_close(&m);
}

static void check_method(const hn_reference *r, const char *scene, const cJSON *entry) {
    hn_model m;
    row rows[MAX_ROWS];
    char where[512];
    const char *method = need(entry, "method")->valuestring;
    int n = list_rows(r, entry, rows);
    (void)snprintf(where, sizeof where, "%s by %s", scene, method);
    open_scene(r, scene, &m);
    hn_run *run = hn_motion_start(&m, method);
    for (int i = 0; i < n; i++) {
        hn_sample s = hn_motion_at(run, rows[i].t);
        hn_reference_state found = convert(r, &m, &s);
        must_agree(r, where, &rows[i], &found);
    }
    hn_run_free(run);
    hn_model_close(&m);
}

void hn_reference_check(const char *name) {
    hn_reference *r = hn_reference_open(name);
    assert_true(hn_reference_scenes(r) > 0 && hn_reference_methods(r) > 1);
    for (int i = 0; i < hn_reference_scenes(r); i++) {
        for (int k = 0; k < hn_reference_methods(r); k++) {
            const cJSON *entry = method_entry(r, k);
            if (cJSON_GetObjectItemCaseSensitive(entry, "stops")) {
                must_stop(r, hn_reference_scene(r, i), entry);
            } else {
                check_method(r, hn_reference_scene(r, i), entry);
            }
        }
    }
    hn_reference_close(r);
}
