// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/variant.h"

#include "base/hash.h"
#include "grade/follow_on.h"
#include "grade/parts/blank.h"
#include "grade/repeated_member.h"
#include "grade/rubric.h"
#include "grade/student_name.h"
#include "grade/submission.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The seed of the order of a part's options. The names of the exercise and of the part count: who
/// has found the right letter of one part knows nothing of another's with the same seed.
static uint64_t seed_letters(const hn_variant *x, const hn_part *p) {
    if (x->exercise->first_letters) {
        return p->seed ^ 0xdea1; // alike for the first parts of all exercises, for the second, ...
    }
    const uint64_t names = hn_hash_text(hn_hash_text(HN_HASH_START, x->exercise->id), p->id);
    return hn_hash_mix(names ^ hn_hash_mix(x->seed));
}

hn_status hn_variant_init(hn_variant *x, const hn_exercise *exercise, uint64_t seed,
                          hn_diag *diag) {
    memset(x, 0, sizeof *x);
    x->exercise = exercise;
    x->seed = seed ? seed : exercise->seed;
    x->chosen = seed != 0;
    x->n_parts = exercise->n_parts;
    const hn_status status =
        hn_draw_init(&x->draw, cJSON_GetObjectItemCaseSensitive(exercise->root, "draw"),
                     cJSON_GetObjectItemCaseSensitive(exercise->root, "conditions"), NULL, 1,
                     hn_hash_mix(x->seed), diag);
    for (int i = 0; i < x->n_parts; i++) {
        x->part[i] = exercise->parts[i];
        x->part[i].draw = &x->draw;
        x->part[i].lib = exercise->lib;
        x->part[i].interrupt = exercise->interrupt;
        x->part[i].seed = hn_hash_mix(x->seed + 7919 * (uint64_t)(i + 1));
        x->part[i].letters = seed_letters(x, &x->part[i]);
    }
    return status;
}

void hn_variant_reset(hn_variant *x) {
    hn_draw_reset(&x->draw);
}

uint64_t hn_variant_seed(const hn_exercise *exercise, const char *student) {
    uint64_t hash = hn_hash_text(HN_HASH_START, exercise->id);
    hash = hn_hash_mix(hn_student_name_hash(hash, student));
    return (hash & ((1ull << 48) - 1)) + 1; // programs that read it as a double keep it
}

uint64_t hn_variant_seed_said(const hn_exercise *exercise, const cJSON *submission) {
    const cJSON *seed = cJSON_GetObjectItemCaseSensitive(submission, "seed");
    const cJSON *student = cJSON_GetObjectItemCaseSensitive(submission, "student");

    // a seed goes before a name; 'problem --json' writes it as text
    if (cJSON_IsString(seed)) {
        const char *text = seed->valuestring;
        const size_t n = strspn(text, "0123456789");
        return n > 0 && n < 19 && !text[n] ? strtoull(text, NULL, 10) : 0;
    }
    if (cJSON_IsNumber(seed)) {
        const double value = seed->valuedouble;
        return value >= 1 && value <= 9007199254740992.0 && value == floor(value) ? (uint64_t)value
                                                                                  : 0;
    }
    const bool named = cJSON_IsString(student) && student->valuestring[0];
    return named ? hn_variant_seed(exercise, student->valuestring) : 0;
}

bool hn_variant_check_names(const hn_exercise *exercise, const cJSON *submission, hn_verdict *v) {
    const cJSON *seed = cJSON_GetObjectItemCaseSensitive(submission, "seed");
    const char *student =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(submission, "student"));
    const uint64_t said = hn_variant_seed_said(exercise, submission);
    if (!seed || said == 0 || !student || !student[0] ||
        said == hn_variant_seed(exercise, student)) {
        return true;
    }
    hn_submission_refuse(
        v, "keep the one whose numbers were used, or grade with --seed or --student",
        "the submission says seed %llu and student '%.60s', whose variant has the "
        "seed %llu",
        (unsigned long long)said, student, (unsigned long long)hn_variant_seed(exercise, student));
    return false;
}

// ---- grading ----

/// The share of an entry. A second mistake beside the one that is named lowers the rubric's share
/// as it lowers the exercise's own.
static double share_of(const hn_rubric *rubric, const hn_part_result *r) {
    const double lowered = r->alone > 0 ? r->share / r->alone : 1;
    const double said = hn_rubric_share(rubric, r->mistake, (double)NAN);
    return r->right || isnan(said) ? r->share : lowered * said;
}

/// Puts a right answer behind the words that say what is expected, where many are right.
static void add_example(hn_entry_verdict *e, const hn_part *p) {
    hn_diag diag = {0};
    cJSON *right = p->kind->is_open && !e->right ? p->kind->right(p, &diag) : NULL;
    char *text = right && !cJSON_IsString(right) ? cJSON_PrintUnformatted(right) : NULL;
    const char *example = text ? text : cJSON_GetStringValue(right);
    const size_t used = strlen(e->expected);
    if (example) {
        snprintf(e->expected + used, sizeof e->expected - used, ", for example %s", example);
    }
    cJSON_free(text);
    cJSON_Delete(right);
}

/// Copies what a kind of answer found into entries of the verdict.
static void add_results(hn_verdict *v, const hn_part *p, const hn_part_result *results, int n) {
    for (int i = 0; i < n && v->n_entries < HN_GRADE_MAX_ENTRIES; i++) {
        const hn_part_result *r = &results[i];
        hn_entry_verdict *e = &v->entry[v->n_entries++];
        *e =
            (hn_entry_verdict){.row = v->n_entries - 1, .state = -1, .n_whole = (int)strlen(p->id)};
        snprintf(e->name, sizeof e->name, "%s%s%.12s", p->id, r->name[0] ? "." : "", r->name);
        e->max_points = p->points / n;
        e->points = e->max_points * share_of(v->problem->rubric, r);
        e->right = r->right;
        e->mistake = r->mistake;
        e->likeness = r->likeness;
        snprintf(e->explanation, sizeof e->explanation, "%s", r->explanation);
        snprintf(e->given, sizeof e->given, "%s", r->given);
        snprintf(e->expected, sizeof e->expected, "%s", r->expected);
        add_example(e, p);
        snprintf(e->read_as, sizeof e->read_as, "%s", r->read_as);
        v->n_right += r->right;
        v->n_unreadable += r->unreadable;
        v->score += e->points;
    }
}

/// "student 'Ada' (seed 7)" where a student has this variant, else "seed 7".
static void name_variant(const hn_variant *x, char *out, size_t size) {
    const hn_exercise *e = x->exercise;
    for (int i = 0; i < e->n_owners; i++) {
        if (e->owners[i].seed == x->seed) {
            snprintf(out, size, "student '%.60s' (seed %llu)", e->owners[i].name,
                     (unsigned long long)x->seed);
            return;
        }
    }
    snprintf(out, size, "seed %llu", (unsigned long long)x->seed);
}

/// The variant that a submission says it answers, by its seed or else its student, and how it is
/// graded. said = 0: its seed is no number of a variant.
static void name_said(const cJSON *seed, const cJSON *student, uint64_t said, char *out,
                      size_t size, char *hint, size_t hint_size) {
    const bool by_seed = cJSON_IsNumber(seed) || cJSON_IsString(seed);
    if (!by_seed) {
        snprintf(out, size, "student '%.60s'", student->valuestring);
        snprintf(hint, hint_size, "grade it with --student '%.60s'", student->valuestring);
    } else if (said) {
        snprintf(out, size, "seed %llu", (unsigned long long)said);
        snprintf(hint, hint_size, "grade it with --seed %llu", (unsigned long long)said);
    } else {
        char number[24];
        snprintf(number, sizeof number, "%.17g", cJSON_IsNumber(seed) ? seed->valuedouble : 0);
        snprintf(out, size, "seed '%.20s'", cJSON_IsNumber(seed) ? number : seed->valuestring);
        snprintf(hint, hint_size, "a seed is a whole number from 1; 'holonom problem' prints it");
    }
}

/// Refuses a submission that says it answers another variant.
static int check_seed(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    const cJSON *seed = cJSON_GetObjectItemCaseSensitive(submission, "seed");
    const cJSON *student = cJSON_GetObjectItemCaseSensitive(submission, "student");
    const uint64_t said = hn_variant_seed_said(x->exercise, submission);
    if (said == x->seed || (said == 0 && !cJSON_IsNumber(seed) && !cJSON_IsString(seed))) {
        const bool both = said && seed && cJSON_IsString(student) && student->valuestring[0];
        if (both && hn_variant_seed(x->exercise, student->valuestring) != x->seed) {
            hn_submission_remark(v, "graded as the variant of seed %llu, not as that of '%.60s'",
                                 (unsigned long long)x->seed, student->valuestring);
        }
        return 1;
    }

    char own[120], other[80], hint[100];
    name_variant(x, own, sizeof own);
    name_said(seed, student, said, other, sizeof other, hint, sizeof hint);
    return hn_submission_refuse(
        v, hint, "the submission answers the variant of %s, this is that of %s", other, own);
}

/// The hints that a submission says were used: a whole number of those that there are.
static int check_hints(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(submission, "hints");
    const int n = x->exercise->n_hints;
    const double said = cJSON_IsNumber(m) ? m->valuedouble : -1;
    if (!m || cJSON_IsNull(m) || (said >= 0 && said <= n && said == floor(said))) {
        return 1;
    }
    char *given = cJSON_PrintUnformatted(m);
    hn_submission_refuse(v, "\"hints\" is how many hints were read; leave it out for none",
                         "\"hints\" is %.60s; a whole number from 0 to %d is allowed",
                         given ? given : "", n);
    cJSON_free(given);
    return 0;
}

/// Returns whether a member of an answer is read as a name of a list in the exercise's part.
static bool is_read(const hn_part *p, const char *list, const cJSON *answer, const cJSON *member) {
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, list)) {
        if (cJSON_IsString(m) && hn_part_member(answer, m->valuestring) == member) {
            return true;
        }
    }
    return false;
}

/// Remarks on what the answer to a part holds beside the names that the part asks for. A whole
/// scene has fields of its own.
static void remark_unread_names(const hn_part *p, const cJSON *answer, hn_verdict *v) {
    static const char *const lists[] = {"free", "given", "numbers", "asked"};
    const bool scene = cJSON_GetObjectItemCaseSensitive(answer, "holonom") != NULL;
    const char *kind = hn_part_text(p->node, "kind");
    const bool named = strcmp(kind, "scene") == 0 || strcmp(kind, "example") == 0 ||
                       strcmp(kind, "configuration") == 0;
    for (const cJSON *m = cJSON_IsObject(answer) && named && !scene ? answer->child : NULL; m;
         m = m->next) {
        bool known = false;
        for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
            known |= is_read(p, lists[i], answer, m);
        }
        if (!known) {
            hn_submission_remark(v, "in part %.20s the field '%.50s' was not read", p->id,
                                 m->string);
        }
    }
}

/// Fields that no part asks for; the file of another exercise or another seed.
static int check_fields(hn_variant *x, const cJSON *submission, hn_verdict *v) {
    static const char *const others[] = {"problem", "exercise", "student", "seed",
                                         "comment", "hints",    NULL};
    const char *fields[HN_GRADE_MAX_PARTS + 6];
    int answers = 0;

    // each field is a part, or one that every submission may have
    for (int i = 0; i < x->n_parts; i++) {
        fields[i] = x->part[i].id;
        const cJSON *answer = cJSON_GetObjectItemCaseSensitive(submission, x->part[i].id);
        answers += answer != NULL;
        remark_unread_names(&x->part[i], answer, v);
    }
    memcpy(fields + x->n_parts, others, 6 * sizeof *others);
    hn_submission_remark_unread(v, submission, fields, x->n_parts + 6);
    if (!hn_submission_check_once(v, submission, others)) {
        return 0;
    }

    // it must be meant for this exercise
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(submission, "problem");
    if (cJSON_IsString(id) && strcmp(id->valuestring, x->exercise->id) != 0) {
        return hn_submission_refuse(v, NULL, "the submission says it answers '%.40s', this is '%s'",
                                    id->valuestring, x->exercise->id);
    }
    if (!check_seed(x, submission, v) || !check_hints(x, submission, v)) {
        return 0;
    }

    // a submission without any answer is no attempt
    return answers > 0
               ? 1
               : hn_submission_refuse(v, "'holonom problem' shows the shape of a submission",
                                      "no part of the exercise is answered (the first is "
                                      "'%s')",
                                      x->part[0].id);
}

static void summarise(hn_verdict *v) {
    const char *first = "";
    for (int k = v->n_entries; k-- > 0;) {
        first = v->entry[k].right ? first : v->entry[k].name;
    }
    if (v->n_right == v->n_entries) {
        snprintf(v->summary, sizeof v->summary, "all %d answers are right", v->n_entries);
    } else {
        snprintf(v->summary, sizeof v->summary, "%d of %d answers are right; look first at '%s'",
                 v->n_right, v->n_entries, first);
    }
    if (v->n_unreadable) {
        const size_t used = strlen(v->summary);
        snprintf(v->summary + used, sizeof v->summary - used, "; %d cannot be read",
                 v->n_unreadable);
    }
}

/// Ungradable when nothing that was handed in can be read.
static void refuse_unreadable(hn_verdict *v) {
    int handed_in = 0, first = -1;
    for (int k = v->n_entries; k-- > 0;) {
        handed_in += strcmp(v->entry[k].mistake, "blank") != 0;
        first = strcmp(v->entry[k].mistake, "unreadable") == 0 ? k : first;
    }
    if (first >= 0 && v->n_unreadable == handed_in) {
        hn_submission_refuse(v, v->entry[first].explanation, "no answer can be read (%s)",
                             v->entry[first].name);
    }
}

/// Takes off what the hints that the submission says it used cost by the rubric.
static void charge_hints(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    const int n = (int)hn_part_number(submission, "hints", 0);
    const double cost = fmin(hn_rubric_hints_cost(x->exercise->rubric, n), v->score);
    if (cost > 0) {
        v->score -= cost;
        hn_submission_remark(v, "%d hint%s cost %g point%s", n, n == 1 ? "" : "s", cost,
                             cost == 1 ? "" : "s");
    }
}

/// Draws what a picture shows: the first wrong answer that describes a scene.
static void show_answer(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    for (int k = 0; k < v->n_entries && v->shown_entry < 0; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        const size_t n = strcspn(e->name, ".");
        const bool read = !e->right && strcmp(e->mistake, "unreadable") != 0;
        for (int i = 0; i < x->n_parts && read; i++) {
            const hn_part *p = &x->part[i];
            if (p->kind->view && strlen(p->id) == n && strncmp(p->id, e->name, n) == 0) {
                p->kind->view(p, cJSON_GetObjectItemCaseSensitive(submission, p->id), &v->view);
                v->shown_entry = v->view.scene ? k : -1;
            }
        }
    }
}

/// Grades the answer to one part. One that is there twice, or has a member twice, with different
/// values is not read: which of them was meant cannot be told.
static hn_status grade_part(const hn_part *p, const cJSON *submission,
                            hn_part_result results[HN_PART_RESULTS], int *n, hn_diag *diag) {
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(submission, p->id);
    const cJSON *given = hn_blank_is(member) ? NULL : member;
    const bool twice = hn_repeated_member_is(submission, p->id);
    const char *name = twice ? p->id : hn_repeated_member_find(given);
    HN_TRY(p->kind->grade(p, name ? NULL : given, results, n, diag));
    for (int i = 0; name && i < *n; i++) {
        hn_part_unreadable(
            &results[i], "'%.60s' is there more than once, with different values: keep one", name);
        hn_part_keep_given(&results[i], given);
    }
    return HN_OK;
}

hn_status hn_variant_grade(hn_variant *x, const cJSON *submission, hn_verdict *v, hn_diag *diag) {
    if (!cJSON_IsObject(submission)) {
        hn_submission_refuse(v, "as in {\"a\": 1.2, \"b\": \"...\"}",
                             "the submission is no object with a member for each part");
        return HN_OK;
    }
    if (!check_fields(x, submission, v)) {
        return HN_OK;
    }
    for (int i = 0; i < x->n_parts; i++) {
        hn_part_result results[HN_PART_RESULTS];
        int n = 0;
        const hn_status status = grade_part(&x->part[i], submission, results, &n, diag);
        if (hn_interrupt_ask(&x->exercise->interrupt)) {
            return HN_ERR_STOPPED;
        }
        HN_TRY(status);
        if (n == 1) {
            hn_follow_on_find(x, i, submission, v, &results[0]);
        }
        add_results(v, &x->part[i], results, n);
    }
    hn_submission_remark_read_as(v);
    show_answer(x, submission, v);
    charge_hints(x, submission, v);
    summarise(v);
    refuse_unreadable(v);
    return HN_OK;
}
