// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise_check.h"

#include "base/hash.h"
#include "grade/variant.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SEEDS = 100000 };

/// The variant under test.
typedef struct trial {
    hn_variant variant;
    hn_exercise_report *report;
    int good;
} trial;

static void complain(trial *t, const char *part, const char *format, ...) HN_PRINTF(3, 4);

static void complain(trial *t, const char *part, const char *format, ...) {
    hn_exercise_report *r = t->report;
    t->good = 0;
    if (!r->first[0]) {
        const int n = snprintf(r->first, sizeof r->first,
                               "seed %llu%s%s: ", (unsigned long long)t->variant.seed,
                               part[0] ? ", part " : "", part);
        va_list list;
        va_start(list, format);
        vsnprintf(r->first + n, sizeof r->first - (size_t)n, format, list);
        va_end(list);
    }
}

/// The right answer of a part gets every point.
static hn_status try_right(trial *t, const hn_part *p) {
    hn_part_result results[HN_PART_RESULTS];
    hn_diag diag = {0};
    int n = 0;

    // the answer that the exercise itself gives
    cJSON *answer = p->kind->right(p, &diag);
    if (!answer) {
        complain(t, p->id, "there is no right answer: %s", diag.message);
        return HN_OK;
    }
    t->report->rights++;

    // graded as a student's, it must pass in every entry
    const hn_status status = p->kind->grade(p, answer, results, &n, &diag);
    for (int i = 0; i < n && status == HN_OK; i++) {
        if (!results[i].right) {
            complain(t, p->id, "the reference is not accepted (%s): %s", results[i].mistake,
                     results[i].explanation);
        }
    }
    if (status != HN_OK) {
        complain(t, p->id, "%s", diag.message);
    }
    cJSON_Delete(answer);
    return status == HN_ERR_MEMORY ? status : HN_OK;
}

/// A listed mistake is named. One id may stand for several answers, and an answer that two ids
/// give is named by the first.
static hn_status try_fault(trial *t, const hn_part *p, const cJSON *answer, const char *id) {
    hn_part_result results[HN_PART_RESULTS];
    hn_diag diag = {0};
    int n = 0, named = 0, wrong = 0;

    // graded as if a student had handed it in
    t->report->faults++;
    const hn_status status = p->kind->grade(p, answer, results, &n, &diag);
    if (status != HN_OK) {
        complain(t, p->id, "%s", diag.message);
        return status == HN_ERR_MEMORY ? status : HN_OK;
    }

    // an entry may be wrong under another name, or not at all
    for (int i = 0; i < n; i++) {
        wrong += !results[i].right;
        named += !results[i].right && strcmp(results[i].mistake, id) == 0;
    }

    // the author sees the answer, and what it was taken for
    if (!named) {
        char *text = cJSON_PrintUnformatted(answer);
        complain(t, p->id, "the mistake '%s' (%.150s) is %s%s", id, text ? text : "",
                 wrong ? "named " : "taken for right", wrong ? results[0].mistake : "");
        free(text);
    }
    return HN_OK;
}

static hn_status try_faults(trial *t, const hn_part *p) {
    const char *id = "";
    hn_diag diag = {0};
    cJSON *answer;
    hn_status status = HN_OK;
    for (int i = 0; status == HN_OK && (answer = p->kind->fault(p, i, &id, &diag)) != NULL; i++) {
        if (id[0]) {
            status = try_fault(t, p, answer, id);
        }
        cJSON_Delete(answer);
    }
    return status;
}

static hn_status try_part(trial *t, const hn_part *p) {
    hn_diag diag = {0};
    if (p->kind->prove && p->kind->prove(p, &diag) != HN_OK) {
        complain(t, p->id, "%s", diag.message);
    }
    HN_TRY(try_right(t, p));
    return try_faults(t, p);
}

/// A hash of the numbers of a variant, and of the order of its options.
static uint64_t hash_of(const hn_variant *x) {
    uint64_t hash = HN_HASH_START;
    for (int i = 0; i < x->draw.n_names; i++) {
        hash = hn_hash_double(hash, x->draw.value[0][i]);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (int i = 0; i < x->n_parts; i++) {
        x->part[i].kind->ask(&b, &x->part[i]);
    }
    hash = hn_hash_bytes(hash, hn_strbuf_text(&b), b.n);
    hn_strbuf_reset(&b);
    return hn_hash_mix(hash);
}

static int compare_hashes(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static long long count_distinct(uint64_t *hashes, long long n) {
    qsort(hashes, (size_t)n, sizeof *hashes, compare_hashes);
    long long distinct = n > 0;
    for (long long i = 1; i < n; i++) {
        distinct += hashes[i] != hashes[i - 1];
    }
    return distinct;
}

static hn_status try_seed(const hn_exercise *exercise, uint64_t seed, uint64_t *hash,
                          hn_exercise_report *out) {
    trial t = {.report = out, .good = 1};
    hn_diag diag = {0};
    hn_status status = hn_variant_init(&t.variant, exercise, seed, &diag);
    if (status == HN_OK) {
        *hash = hash_of(&t.variant);
        for (int i = 0; i < t.variant.n_parts && status == HN_OK; i++) {
            status = try_part(&t, &t.variant.part[i]);
        }
    } else {
        complain(&t, "", "%s", diag.message);
        status = status == HN_ERR_MEMORY ? status : HN_OK;
    }
    out->variants++;
    out->bad += !t.good;
    hn_variant_reset(&t.variant);
    return status;
}

hn_status hn_exercise_check(const hn_exercise *exercise, uint64_t from, uint64_t to,
                            hn_exercise_report *out) {
    memset(out, 0, sizeof *out);
    const uint64_t n = to - from + 1 < MAX_SEEDS ? to - from + 1 : MAX_SEEDS;
    uint64_t *hashes = calloc(n, sizeof *hashes);
    hn_status status = hashes ? HN_OK : HN_ERR_MEMORY;
    for (uint64_t i = 0; i < n && status == HN_OK; i++) {
        status = try_seed(exercise, from + i, &hashes[i], out);
    }
    out->distinct = hashes ? count_distinct(hashes, out->variants) : 0;
    free(hashes);
    return status;
}
