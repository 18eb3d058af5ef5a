// What is kept of an unfinished study between two runs of the program: a log that is read up to its last whole line.
#include "session/stored_json.h"
#include "session/study_internal.h"

#include "base/hash.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { FORMAT = 1 }; // FORMAT counts up when the meaning of a line changes

// the log of an unfinished study -----------------------------------------------------------------------------------

/// All that decides what the points are: everything but the budget.
static uint64_t study_key(const hn_study *s) {
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &s->ref->scene, sizeof s->ref->scene);
    hash = hn_hash_double(hash, s->ref->T);
    hash = hn_hash_double(hash, s->ref->n + 1000.0 * FORMAT);
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
    if (!hn_stored_number(o, "state", &state) || !hn_stored_number(o, "status", &status) ||
        !hn_stored_text(o, "reason", p->reason, sizeof p->reason) ||
        !hn_stored_numbers(o, "numbers", numbers, 5) ||
        !hn_stored_numbers(o, "worst", p->worst, HN_ERROR_COUNT) ||
        !hn_stored_numbers(o, "end", p->end, HN_ERROR_COUNT) ||
        !hn_stored_numbers(o, "q", p->end_q, (size_t)s->ref->n_user) ||
        !hn_stored_numbers(o, "cost", counts, N_COUNTS) ||
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
    int ok = hn_stored_number(o, "m", &m) && hn_stored_number(o, "k", &k) && m >= 0 && k >= 0 &&
             m < s->wp->n_methods && k < s->wp->n_levels;
    if (ok) {
        hn_wp_point *p = &s->wp->methods[(int)m].point[(int)k];
        ok = cJSON_HasObjectItem(o, "cpu")
                 ? hn_stored_number(o, "cpu", &cpu) && hn_stored_number(o, "busy", &busy) &&
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
    char *text = hn_stored_text_of(s->log, &n);
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
