// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_merge.h"

#include "session/precision/study_internal.h"
#include "session/precision/study_store.h"
#include "session/references/reference_store.h"
#include "session/references/references.h"
#include "session/store/stored_json.h"

#include "base/hash.h"
#include "study/cost/shards.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PARTS = 256, SHOWN = 60 };

typedef struct part {
    const char *name;
    cJSON *root;
    int shard, of;
    double time_limit, elapsed;
} part;

/// The best record of a point so far; NULL: none yet.
typedef struct record {
    const part *from;
    const cJSON *o;
} record;

typedef struct merging {
    int n;
    part *parts; ///< n
    hn_study *study;
    record best[HN_WP_METHODS * HN_WP_LEVELS];
    hn_diags *diags;
} merging;

static const cJSON *member(const cJSON *o, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(o, key);
}

/// Returns a member by its path, such as "request/time"; NULL: there is none.
static const cJSON *at_path(const cJSON *o, const char *path) {
    char key[32];
    while (o && *path) {
        const size_t n = strcspn(path, "/");
        snprintf(key, sizeof key, "%.*s", (int)n, path);
        o = member(o, key);
        path += n + (path[n] == '/');
    }
    return o;
}

static const char *text_of(const cJSON *o, const char *path) {
    const char *text = cJSON_GetStringValue(at_path(o, path));
    return text ? text : "";
}

/// Reads a whole number from low to high. Returns 0 when there is none.
static bool whole_of(const cJSON *o, const char *path, int low, int high, int *out) {
    const cJSON *item = at_path(o, path);
    const double x = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    if (!(x >= low && x <= high) || x != floor(x)) {
        return false;
    }
    *out = (int)x;
    return true;
}

// reading ----

static hn_status refuse(merging *g, const part *p, const char *what) {
    return hn_diags_add(g->diags, HN_ERR_INPUT, NULL,
                        "holonom study SCENE --shard i/n --out FILE.json makes one",
                        "'%.120s' is no part of a study: %s", p->name, what);
}

static hn_status read_part(merging *g, const hn_study_part_text *text, part *p) {
    int format = 0;
    p->name = text->name;
    p->root = cJSON_ParseWithLength(text->text, text->n);
    if (!p->root) {
        return refuse(g, p, "it is not complete JSON");
    }

    // kind and version of the document
    if (strcmp(text_of(p->root, "study"), HN_PART_STUDY) != 0) {
        return refuse(g, p, "its field \"study\" has another value");
    }
    if (!whole_of(p->root, "format", 1, 1000, &format) || format != HN_PART_FORMAT) {
        return refuse(g, p, "it was written by a version of holonom with another format");
    }

    // which part it is, and its points
    if (!whole_of(p->root, "of", 1, HN_WP_SHARDS, &p->of) ||
        !whole_of(p->root, "shard", 1, p->of, &p->shard) ||
        !hn_stored_number(p->root, "time_limit", &p->time_limit) ||
        !hn_stored_number(p->root, "elapsed", &p->elapsed) ||
        !cJSON_IsArray(member(p->root, "points"))) {
        return refuse(g, p, "some of its fields are missing");
    }
    return HN_OK;
}

// agreeing ----

/// Returns 1 when both are equal. `said` receives both, shortened, for a message.
static int say_the_same(const cJSON *a, const cJSON *b, char said[2][SHOWN]) {
    char *x = cJSON_PrintUnformatted(a), *y = cJSON_PrintUnformatted(b);
    const int same = x && y && strcmp(x, y) == 0;
    snprintf(said[0], SHOWN, "%s", x ? x : "nothing");
    snprintf(said[1], SHOWN, "%s", y ? y : "nothing");
    cJSON_free(x);
    cJSON_free(y);
    return same;
}

static hn_status contradict(merging *g, const part *a, const part *b, const char *field,
                            char said[2][SHOWN]) {
    return hn_diags_add(g->diags, HN_ERR_INPUT, NULL, NULL,
                        "'%.100s' and '%.100s' contradict each other in %s: %s and %s", a->name,
                        b->name, field, said[0], said[1]);
}

/// Checks that all parts agree in scene, request, build and reference.
static hn_status compare_heads(merging *g) {
    static const char *const fields[] = {"scene/hash",      "scene/id",       "build",
                                         "request/time",    "request/levels", "request/samples",
                                         "request/methods", "request/step",   "reference",
                                         "scene/set",       "scene/text"};
    for (int i = 1; i < g->n; i++) {
        for (size_t f = 0; f < sizeof fields / sizeof *fields; f++) {
            char said[2][SHOWN];
            const part *a = &g->parts[0], *b = &g->parts[i];
            if (!say_the_same(at_path(a->root, fields[f]), at_path(b->root, fields[f]), said)) {
                return contradict(g, a, b, fields[f], said);
            }
        }
    }
    return HN_OK;
}

// the study ----

static hn_status load_scene(merging *g) {
    const part *p = &g->parts[0];
    char *text = cJSON_PrintUnformatted(at_path(p->root, "scene/text"));
    const cJSON *set = at_path(p->root, "scene/set"), *item;
    hn_setting settings[HN_SCENE_MAX_PARAMS];
    char hex[17];
    int n = 0;

    // parameters that were set
    cJSON_ArrayForEach(item, set) {
        if (n < HN_SCENE_MAX_PARAMS && cJSON_IsNumber(item)) {
            settings[n++] = (hn_setting){item->string, item->valuedouble};
        }
    }
    if (!text) {
        return refuse(g, p, "its scene is missing");
    }

    // load from the text; the parts need no library
    const hn_model_source source = {.text = text,
                                    .n_text = strlen(text),
                                    .id = text_of(p->root, "scene/id"),
                                    .settings = settings,
                                    .n_settings = n};
    const hn_status status = hn_model_load(NULL, &source, &g->study->own_model, g->diags);
    cJSON_free(text);
    if (status != HN_OK) {
        return status;
    }

    // the hash guards against a scene that was edited afterwards
    g->study->model = g->study->own_model;
    hn_hash_hex(hn_model_scene(g->study->model)->hash, hex);
    return strcmp(hex, text_of(p->root, "scene/hash")) == 0
               ? HN_OK
               : refuse(g, p, "its scene does not match its hash: the scene was changed");
}

static hn_status load_reference(merging *g) {
    const part *p = &g->parts[0];
    double T;
    if (!hn_stored_number(at_path(p->root, "request"), "time", &T) || !(T > 0)) {
        return refuse(g, p, "its end time is missing");
    }
    g->study->ref =
        hn_reference_take(member(p->root, "reference"), g->study->model, T, HN_REF_TIMES);
    return g->study->ref ? HN_OK : refuse(g, p, "its reference solution belongs to another scene");
}

static hn_status read_methods(merging *g, hn_method_spec *specs, int *n) {
    const cJSON *item;
    *n = 0;
    cJSON_ArrayForEach(item, at_path(g->parts[0].root, "request/methods")) {
        hn_diag diag = {0};
        const char *spelling = cJSON_GetStringValue(item);
        if (!spelling || *n == HN_WP_METHODS ||
            hn_method_parse(spelling, &specs[*n], &diag) != HN_OK) {
            return refuse(g, &g->parts[0], diag.message[0] ? diag.message : "it names no methods");
        }
        (*n)++;
    }
    return HN_OK;
}

/// Returns the largest time limit of the parts; 0 means no limit and counts as the largest.
static double largest_limit(const merging *g) {
    double largest = g->parts[0].time_limit;
    for (int i = 1; i < g->n; i++) {
        const double here = g->parts[i].time_limit;
        largest = largest == 0 || here == 0 ? 0 : fmax(largest, here);
    }
    return largest;
}

static hn_status set_up(merging *g) {
    hn_study *s = g->study;
    const cJSON *root = g->parts[0].root;
    hn_method_spec specs[HN_WP_METHODS];
    hn_diag diag = {0};
    hn_wp_opts opts = {0};
    int n = 0;

    // scene, reference and methods of the first part: all parts agree in them
    hn_status status = load_scene(g);
    status = status == HN_OK ? load_reference(g) : status;
    status = status == HN_OK ? read_methods(g, specs, &n) : status;
    if (status != HN_OK) {
        return status;
    }

    // options of the ladders
    if (!whole_of(root, "request/levels", 1, HN_WP_LEVELS, &opts.n_levels) ||
        !whole_of(root, "request/samples", -1, HN_WP_SAMPLES, &opts.n_samples) ||
        !hn_stored_number(at_path(root, "request"), "step", &opts.step) || !(opts.step > 0)) {
        return refuse(g, &g->parts[0], "fields of its request are missing");
    }
    opts.time_limit = largest_limit(g);

    // an empty study to fill
    s->request = (hn_job_request){.time = s->ref->T, .limits.time_limit = opts.time_limit};
    status = hn_wp_create(hn_model_system(s->model), hn_model_q(s->model), hn_model_v(s->model),
                          s->ref, specs, n, &opts, &s->wp, &diag);
    return status == HN_OK
               ? HN_OK
               : hn_diags_add(g->diags, status, diag.pointer, diag.hint, "%s", diag.message);
}

// points ----

static int state_of(const cJSON *o) {
    const cJSON *state = member(o, "state");
    return cJSON_IsNumber(state) ? state->valueint : -1;
}

static int samples_of(const cJSON *o) {
    return cJSON_GetArraySize(member(o, "cpu"));
}

/// Returns 1 if record a counts rather than b. The result does not depend on their order.
static int is_better(const cJSON *a, const cJSON *b) {
    const int skipped_a = state_of(a) == HN_WP_SKIPPED, skipped_b = state_of(b) == HN_WP_SKIPPED;
    if (skipped_a != skipped_b) {
        return skipped_b;
    }
    if (samples_of(a) != samples_of(b)) {
        return samples_of(a) > samples_of(b);
    }
    char *x = cJSON_PrintUnformatted(a), *y = cJSON_PrintUnformatted(b);
    const int better = x && y && strcmp(x, y) < 0;
    cJSON_free(x);
    cJSON_free(y);
    return better;
}

/// Checks that two records of a point agree in everything but CPU times.
static hn_status compare_records(merging *g, const record *a, const record *b, int i) {
    static const char *const fields[] = {"state", "status", "reason", "numbers",
                                         "worst", "end",    "q",      "cost"};
    const int L = g->study->wp->n_levels;
    char said[2][SHOWN], spelling[HN_SPEC_MAX], field[HN_SPEC_MAX + 40];
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++) {
        if (!say_the_same(member(a->o, fields[f]), member(b->o, fields[f]), said)) {
            hn_wp_spelling(g->study->wp, i / L, i % L, spelling);
            snprintf(field, sizeof field, "%s of %s", fields[f], spelling);
            return contradict(g, a->from, b->from, field, said);
        }
    }
    return HN_OK;
}

static hn_status take_record(merging *g, const part *p, const cJSON *o) {
    const hn_wp *wp = g->study->wp;
    const record here = {p, o};
    int m, k;
    if (!whole_of(o, "m", 0, wp->n_methods - 1, &m) || !whole_of(o, "k", 0, wp->n_levels - 1, &k)) {
        return refuse(g, p, "it holds a point that its request does not ask for");
    }

    // results of two complete runs must agree
    const int i = m * wp->n_levels + k;
    record *best = &g->best[i];
    if (best->o && state_of(best->o) != HN_WP_SKIPPED && state_of(o) != HN_WP_SKIPPED) {
        const hn_status status = compare_records(g, best, &here, i);
        if (status != HN_OK) {
            return status;
        }
    }

    // keep the better record
    if (!best->o || is_better(o, best->o)) {
        *best = here;
    }
    return HN_OK;
}

static hn_status fill_point(merging *g, const record *r, hn_wp_point *p) {
    const cJSON *item;
    double busy;
    if (!hn_store_take_point(g->study, r->o, p) ||
        !hn_stored_number(r->o, "first_cpu", &p->first_cpu) ||
        !hn_stored_number(r->o, "busy", &busy) || !(busy >= 0 && busy <= HN_WP_SAMPLES)) {
        return refuse(g, r->from, "one of its points is incomplete or out of bounds");
    }
    cJSON_ArrayForEach(item, member(r->o, "cpu")) {
        if (p->state != HN_WP_DONE || !hn_store_take_sample(p, item->valuedouble, busy)) {
            return refuse(g, r->from, "one of its measured times is not a positive number");
        }
    }
    return HN_OK;
}

static hn_status take_points(merging *g) {
    hn_wp *wp = g->study->wp;
    const cJSON *o;

    // choose a record for every point
    for (int i = 0; i < g->n; i++) {
        cJSON_ArrayForEach(o, member(g->parts[i].root, "points")) {
            const hn_status status = take_record(g, &g->parts[i], o);
            if (status != HN_OK) {
                return status;
            }
        }
    }

    // fill the study from the records chosen
    for (int i = 0; i < wp->n_methods * wp->n_levels; i++) {
        if (g->best[i].o) {
            hn_wp_point *p = &wp->methods[i / wp->n_levels].point[i % wp->n_levels];
            const hn_status status = fill_point(g, &g->best[i], p);
            if (status != HN_OK) {
                return status;
            }
        }
    }
    return HN_OK;
}

// what is missing ----

/// Returns the name of the part shard/of, or NULL when it was not given.
static const char *given(const merging *g, int shard, int of) {
    for (int i = 0; i < g->n; i++) {
        if (g->parts[i].shard == shard && g->parts[i].of == of) {
            return g->parts[i].name;
        }
    }
    return NULL;
}

/// Counts in lacks[i] the points of shard i + 1 of n that no part holds. Returns the number of
/// incomplete shards.
static int find_lacking(const merging *g, int n, int lacks[HN_WP_SHARDS]) {
    const hn_wp *wp = g->study->wp;
    int shard[HN_WP_METHODS * HN_WP_LEVELS], found = 0;
    hn_wp_split(wp, n, shard);
    memset(lacks, 0, HN_WP_SHARDS * sizeof *lacks);
    for (int i = 0; i < wp->n_methods * wp->n_levels; i++) {
        found += !g->best[i].o && lacks[shard[i] - 1] == 0;
        lacks[shard[i] - 1] += !g->best[i].o;
    }
    return found;
}

/// Reports the missing parts, for the split of which the fewest are missing.
static hn_status find_missing(merging *g) {
    int lacks[HN_WP_SHARDS], of = 0, least = HN_WP_SHARDS + 1;

    // the split for which the fewest parts are missing
    for (int i = 0; i < g->n; i++) {
        const int found = find_lacking(g, g->parts[i].of, lacks);
        if (found < least || (found == least && g->parts[i].of < of)) {
            least = found;
            of = g->parts[i].of;
        }
    }
    if (least == 0) {
        return HN_OK;
    }

    // name those parts, and whether they were stopped early
    hn_strbuf b;
    hn_strbuf_init(&b);
    find_lacking(g, of, lacks);
    for (int i = 0; i < of; i++) {
        const char *name = given(g, i + 1, of);
        if (lacks[i] > 0) {
            hn_strbuf_printf(&b, "%s%d/%d", b.n ? ", " : "", i + 1, of);
        }
        if (lacks[i] > 0 && name) {
            hn_strbuf_printf(&b, " ('%.80s' was stopped before its end)", name);
        }
    }

    // report
    hn_diags_add(g->diags, HN_ERR_INPUT, "/shard", "run the missing parts with the same request",
                 "%d of %d parts are missing: %.300s", least, of, hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
    return HN_ERR_INPUT;
}

// clocks ----

/// Returns the median time of a part's yardstick; NaN when it has none, or when its method is not
/// that of the first part.
static double yardstick_of(const merging *g, const part *p) {
    hn_wp_point y = {0};
    char said[2][SHOWN];
    const cJSON *item;
    cJSON_ArrayForEach(item, at_path(p->root, "yardstick/cpu")) {
        if (!hn_store_take_sample(&y, item->valuedouble, 0)) {
            return (double)NAN;
        }
    }
    return y.n_samples > 0 && say_the_same(at_path(p->root, "yardstick/method"),
                                           at_path(g->parts[0].root, "yardstick/method"), said)
               ? y.median
               : (double)NAN;
}

/// Computes the ratio of the slowest to the fastest clock; 1 when all texts are copies of one part.
static void compare_clocks(merging *g) {
    double low = HUGE_VAL, high = 0;
    int several = 0;
    for (int i = 0; i < g->n; i++) {
        const double y = yardstick_of(g, &g->parts[i]);
        several |= g->parts[i].shard != g->parts[0].shard || g->parts[i].of != g->parts[0].of;
        low = isnan(y) || isnan(low) ? (double)NAN : fmin(low, y);
        high = isnan(y) ? high : fmax(high, y);
    }
    g->study->wp->clocks_apart = several ? high / low : 1;
}

/// Wall time of all parts; of the same part given twice, the longer one.
static double all_elapsed(const merging *g) {
    double sum = 0;
    for (int i = 0; i < g->n; i++) {
        double longest = 0;
        int is_first = 1;
        for (int j = 0; j < g->n; j++) {
            if (g->parts[j].shard == g->parts[i].shard && g->parts[j].of == g->parts[i].of) {
                is_first &= j >= i;
                longest = fmax(longest, g->parts[j].elapsed);
            }
        }
        sum += is_first ? longest : 0;
    }
    return sum;
}

/// Evaluates the merged points, as after a run.
static void conclude(merging *g) {
    hn_study *s = g->study;
    hn_wp_compare_ends(s->wp);
    compare_clocks(g);
    s->wp->elapsed = all_elapsed(g);
    for (int m = 0; m < s->wp->n_methods; m++) {
        for (int k = 0; k < s->wp->n_levels; k++) {
            const hn_wp_point *p = &s->wp->methods[m].point[k];
            s->wp->out_of_time |= p->state == HN_WP_SKIPPED ||
                                  (p->state == HN_WP_DONE && p->n_samples < s->wp->opts.n_samples);
        }
        hn_wp_classify(s->wp, m, &s->classes[m]);
    }
    hn_study_find_chaos(s, NULL);
}

static hn_status merge(merging *g, const hn_study_part_text *texts) {
    hn_status status = HN_OK;
    for (int i = 0; i < g->n && status == HN_OK; i++) {
        status = read_part(g, &texts[i], &g->parts[i]);
    }
    status = status == HN_OK ? compare_heads(g) : status;
    status = status == HN_OK ? set_up(g) : status;
    status = status == HN_OK ? take_points(g) : status;
    status = status == HN_OK ? find_missing(g) : status;
    if (status == HN_OK) {
        conclude(g);
    }
    return status;
}

hn_status hn_study_merge(const hn_study_part_text *parts, int n, hn_study **out, hn_diags *diags) {
    if (n < 1 || n > MOST_PARTS) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, NULL,
                            "%d parts were given; 1 to %d can be put together", n, MOST_PARTS);
    }

    // the study outlives the merging; everything else is freed here
    merging *g = calloc(1, sizeof *g);
    part *list = calloc((size_t)n, sizeof *list);
    hn_study *s = calloc(1, sizeof *s);
    hn_status status = HN_ERR_MEMORY;
    if (g && list && s) {
        *g = (merging){.n = n, .parts = list, .study = s, .diags = diags};
        status = merge(g, parts);
    } else {
        hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // free what the merging used
    for (int i = 0; list && i < n; i++) {
        cJSON_Delete(list[i].root);
    }
    free(list);
    free(g);
    if (status != HN_OK) {
        hn_study_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}
