// What is kept of studies between two runs of the program. A file that does not fit is not used, never trusted halfway: a reference
// is written beside its place and moved there; a log is read up to its last whole line.
#include "session/study_internal.h"

#include "base/hash.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { FORMAT = 1, MOST_BYTES = 256 << 20 }; // FORMAT counts up when the meaning of a line changes

// files ------------------------------------------------------------------------------------------------------------

/// The whole text, owned; NULL when there is none.
static char *read_all(FILE *f, size_t *n) {
    if (fseek(f, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long size = ftell(f);
    rewind(f);
    char *text = size >= 0 && size <= MOST_BYTES ? malloc((size_t)size + 1) : NULL;
    if (text) {
        *n = fread(text, 1, (size_t)size, f);
        text[*n] = 0;
    }
    return text;
}

static int get_numbers(const cJSON *object, const char *key, double *out, size_t n) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, key), *item;
    if (!cJSON_IsArray(list) || (size_t)cJSON_GetArraySize(list) != n) {
        return 0;
    }
    size_t i = 0;
    cJSON_ArrayForEach(item, list) {
        if (!cJSON_IsNumber(item) && !cJSON_IsNull(item)) {
            return 0;
        }
        out[i++] = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    }
    return 1;
}

static int get_number(const cJSON *object, const char *key, double *out) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    *out = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    return cJSON_IsNumber(item) || cJSON_IsNull(item);
}

static int get_text(const cJSON *object, const char *key, char *out, size_t size) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    return text && (size_t)snprintf(out, size, "%s", text) < size;
}

// references -------------------------------------------------------------------------------------------------------

static uint64_t ref_key(uint64_t scene, double T, int n) {
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &scene, sizeof scene);
    hash = hn_hash_double(hash, T);
    return hn_hash_mix(hn_hash_double(hash, n + 1000.0 * FORMAT));
}

static int ref_path(const char *folder, uint64_t scene, double T, int n, const char *suffix,
                    char out[512]) {
    char hex[17];
    hn_hash_hex(ref_key(scene, T, n), hex);
    return snprintf(out, 512, "%s/reference-%s.json%s", folder, hex, suffix) < 512;
}

static int fill_ref(hn_ref *ref, const cJSON *o) {
    const size_t rows = (size_t)ref->n + 1, nu = (size_t)ref->n_user, nc = (size_t)ref->nc;
    const cJSON *means = cJSON_GetObjectItemCaseSensitive(o, "means");
    double scales[4];
    for (int i = 0; i < HN_REF_MEANS; i++) {
        const char *text = cJSON_GetStringValue(cJSON_GetArrayItem(means, i));
        if (!text) {
            return 0;
        }
        snprintf(ref->means[i], HN_SPEC_MAX, "%s", text);
    }
    if (!get_numbers(o, "scales", scales, 4)) {
        return 0;
    }
    ref->scales = (hn_scales){scales[0], scales[1], scales[2], scales[3]};
    return get_text(o, "refused", ref->refused, sizeof ref->refused) &&
           get_numbers(o, "error", ref->error, HN_ERROR_COUNT) &&
           get_numbers(o, "q", ref->q, rows * nu) && get_numbers(o, "v", ref->v, rows * nu) &&
           get_numbers(o, "lambda", ref->lambda, rows * nc) &&
           get_numbers(o, "energy", ref->energy, rows) &&
           get_numbers(o, "between", ref->between, rows * HN_ERROR_COUNT);
}

hn_ref *hn_store_read_ref(const char *folder, const hn_model *model, double T, int n) {
    const uint64_t scene = hn_model_scene(model)->hash;
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    char path[512];
    size_t size = 0;
    FILE *f = ref_path(folder, scene, T, n, "", path) ? fopen(path, "rb") : NULL;
    char *text = f ? read_all(f, &size) : NULL;
    cJSON *o = text ? cJSON_Parse(text) : NULL;
    hn_ref *ref = o ? hn_ref_blank(scene, T, n, info.n_user, info.nc) : NULL;
    if (ref && !fill_ref(ref, o)) {
        hn_ref_free(ref);
        ref = NULL;
    }
    cJSON_Delete(o);
    free(text);
    if (f) {
        fclose(f);
    }
    return ref;
}

static void put_ref(hn_strbuf *b, const hn_ref *ref) {
    const size_t rows = (size_t)ref->n + 1, nu = (size_t)ref->n_user, nc = (size_t)ref->nc;
    const double scales[4] = {ref->scales.length, ref->scales.rate, ref->scales.reaction,
                              ref->scales.energy};
    hn_json_object(b);
    hn_json_put_number(b, "T", ref->T);
    hn_json_key(b, "means");
    hn_json_array(b);
    for (int i = 0; i < HN_REF_MEANS; i++) {
        hn_json_string(b, ref->means[i]);
    }
    hn_json_end_array(b);
    hn_json_put_string(b, "refused", ref->refused);
    hn_json_put_numbers(b, "scales", scales, 4);
    hn_json_put_numbers(b, "error", ref->error, HN_ERROR_COUNT);
    hn_json_put_numbers(b, "q", ref->q, rows * nu);
    hn_json_put_numbers(b, "v", ref->v, rows * nu);
    hn_json_put_numbers(b, "lambda", ref->lambda, rows * nc);
    hn_json_put_numbers(b, "energy", ref->energy, rows);
    hn_json_put_numbers(b, "between", ref->between, rows * HN_ERROR_COUNT);
    hn_json_end_object(b);
}

int hn_store_write_ref(const char *folder, const hn_ref *ref) {
    char path[512], beside[512], suffix[32];
    hn_strbuf b;
    snprintf(suffix, sizeof suffix, ".%ld", (long)getpid());
    if (!ref_path(folder, ref->scene, ref->T, ref->n, "", path) ||
        !ref_path(folder, ref->scene, ref->T, ref->n, suffix, beside)) {
        return 0;
    }
    hn_strbuf_init(&b);
    put_ref(&b, ref);
    FILE *f = b.failed ? NULL : fopen(beside, "wb");
    int ok = f && fwrite(hn_strbuf_text(&b), 1, b.n, f) == b.n;
    ok = f && fclose(f) == 0 && ok && rename(beside, path) == 0;
    if (f && !ok) {
        remove(beside);
    }
    hn_strbuf_reset(&b);
    return ok;
}

// the log of an unfinished study -----------------------------------------------------------------------------------

/// All that decides what the points are: everything but the budget.
static uint64_t study_key(const hn_study *s) {
    uint64_t hash = ref_key(s->ref->scene, s->ref->T, s->ref->n);
    hash = hn_hash_double(hash, s->wp->n_levels);
    hash = hn_hash_double(hash, s->wp->opts.step);
    for (int m = 0; m < s->wp->n_methods; m++) {
        char spelling[HN_SPEC_MAX];
        hn_wp_spelling(s->wp, m, 0, spelling);
        hash = hn_hash_text(hash, spelling);
    }
    return hn_hash_mix(hash);
}

/// The counters of a cost, in the order they are written.
enum { N_COUNTS = 11 };
static void counts_of(const hn_cost *c, double out[N_COUNTS]) {
    const double list[N_COUNTS] = {(double)c->evals,
                                   (double)c->factorisations,
                                   (double)c->solves,
                                   (double)c->newton,
                                   c->ops,
                                   (double)c->fallbacks,
                                   (double)c->refinements,
                                   (double)c->projections,
                                   c->energy_removed,
                                   (double)c->chart_changes,
                                   (double)c->rejected};
    memcpy(out, list, sizeof list);
}

static hn_cost cost_of(const double n[N_COUNTS]) {
    return (hn_cost){.evals = (long long)n[0],
                     .factorisations = (long long)n[1],
                     .solves = (long long)n[2],
                     .newton = (long long)n[3],
                     .ops = n[4],
                     .fallbacks = (long long)n[5],
                     .refinements = (long long)n[6],
                     .projections = (long long)n[7],
                     .energy_removed = n[8],
                     .chart_changes = (long long)n[9],
                     .rejected = (long long)n[10]};
}

static void put_point(hn_strbuf *b, const hn_study *s, int m, int k) {
    const hn_wp_point *p = &s->wp->methods[m].point[k];
    double counts[N_COUNTS];
    counts_of(&p->cost, counts);
    const double numbers[] = {p->t_reached, p->own, (double)p->steps, (double)p->rejected,
                              p->first_cpu};
    hn_json_object(b);
    hn_json_put_int(b, "m", m);
    hn_json_put_int(b, "k", k);
    hn_json_put_int(b, "state", p->state);
    hn_json_put_int(b, "status", p->status);
    hn_json_put_string(b, "reason", p->reason);
    hn_json_put_numbers(b, "numbers", numbers, 5);
    hn_json_put_numbers(b, "worst", p->worst, HN_ERROR_COUNT);
    hn_json_put_numbers(b, "end", p->end, HN_ERROR_COUNT);
    hn_json_put_numbers(b, "q", p->end_q, (size_t)s->ref->n_user);
    hn_json_put_numbers(b, "cost", counts, N_COUNTS);
    hn_json_end_object(b);
}

/// A point line into the study; 0 when it is not one.
static int take_point(hn_study *s, const cJSON *o, hn_wp_point *p) {
    double state, status, numbers[5], counts[N_COUNTS];
    if (!get_number(o, "state", &state) || !get_number(o, "status", &status) ||
        !get_text(o, "reason", p->reason, sizeof p->reason) ||
        !get_numbers(o, "numbers", numbers, 5) ||
        !get_numbers(o, "worst", p->worst, HN_ERROR_COUNT) ||
        !get_numbers(o, "end", p->end, HN_ERROR_COUNT) ||
        !get_numbers(o, "q", p->end_q, (size_t)s->ref->n_user) ||
        !get_numbers(o, "cost", counts, N_COUNTS) ||
        (state != HN_WP_DONE && state != HN_WP_FAILED)) {
        return 0;
    }
    p->state = (hn_wp_state)state;
    p->status = (hn_status)status;
    p->t_reached = numbers[0];
    p->own = numbers[1];
    p->steps = (long long)numbers[2];
    p->rejected = (long long)numbers[3];
    p->first_cpu = numbers[4];
    p->cost = cost_of(counts);
    s->resumed++;
    return 1;
}

static int take_sample_line(hn_wp_point *p, double cpu, double busy) {
    if (p->state != HN_WP_DONE || p->n_samples >= HN_WP_SAMPLES || !(cpu >= 0)) {
        return 0;
    }
    p->sample[p->n_samples++] = cpu;
    p->busy = (int)busy;
    hn_wp_point_statistics(p);
    return 1;
}

/// One line of the log; 0 when it is none, or torn.
static int take_line(hn_study *s, const char *line) {
    cJSON *o = cJSON_Parse(line);
    double m = -1, k = -1, cpu, busy;
    int ok = get_number(o, "m", &m) && get_number(o, "k", &k) && m >= 0 && k >= 0 &&
             m < s->wp->n_methods && k < s->wp->n_levels;
    if (ok) {
        hn_wp_point *p = &s->wp->methods[(int)m].point[(int)k];
        ok = cJSON_HasObjectItem(o, "cpu")
                 ? get_number(o, "cpu", &cpu) && get_number(o, "busy", &busy) &&
                       take_sample_line(p, cpu, busy)
                 : take_point(s, o, p);
    }
    cJSON_Delete(o);
    return ok;
}

/// Reads whole lines into the study; returns the bytes they take.
static size_t take_lines(hn_study *s, char *text) {
    size_t used = 0;
    for (char *end; (end = strchr(text + used, '\n')) != NULL;) {
        *end = 0;
        if (!take_line(s, text + used)) {
            break;
        }
        used = (size_t)(end - text) + 1;
    }
    return used;
}

hn_status hn_store_open_log(hn_study *s, hn_diags *diags) {
    char hex[17];
    size_t n = 0;
    hn_hash_hex(study_key(s), hex);
    if (snprintf(s->log_path, sizeof s->log_path, "%s/study-%s.ndjson", s->request.folder, hex) >=
        (int)sizeof s->log_path) {
        s->log_path[0] = 0;
        return HN_OK;
    }
    s->log = fopen(s->log_path, "a+b");
    if (!s->log) {
        return hn_diags_add(diags, HN_ERR_IO, NULL, NULL, "cannot keep the study in '%.200s': %s",
                            s->log_path, strerror(errno));
    }
    if (flock(fileno(s->log), LOCK_EX | LOCK_NB) != 0) {
        fclose(s->log);
        s->log = NULL;
        return hn_diags_add(diags, HN_ERR_IO, NULL,
                            "wait for it, or change the time or the methods",
                            "another program is at this very study");
    }
    char *text = read_all(s->log, &n);
    const size_t used = text ? take_lines(s, text) : 0;
    free(text);
    // what comes next is written behind the last whole line
    if (ftruncate(fileno(s->log), (off_t)used) != 0) {
        s->log_failed = 1;
    }
    return HN_OK;
}

void hn_store_close_log(hn_study *s, int finished) {
    if (s->log) {
        if (finished) {
            remove(s->log_path);
        }
        fclose(s->log);
        s->log = NULL;
    }
}

static void write_line(hn_study *s, hn_strbuf *b) {
    hn_strbuf_add(b, "\n");
    if (s->log && !s->log_failed) {
        s->log_failed =
            b->failed || fwrite(hn_strbuf_text(b), 1, b->n, s->log) != b->n || fflush(s->log) != 0;
    }
    hn_strbuf_reset(b);
}

void hn_store_log_point(hn_study *s, int m, int k) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    put_point(&b, s, m, k);
    write_line(s, &b);
}

void hn_store_log_sample(hn_study *s, int m, int k) {
    const hn_wp_point *p = &s->wp->methods[m].point[k];
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "m", m);
    hn_json_put_int(&b, "k", k);
    hn_json_put_number(&b, "cpu", p->sample[p->n_samples - 1]);
    hn_json_put_int(&b, "busy", p->busy);
    hn_json_end_object(&b);
    write_line(s, &b);
}
