// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/filled_parts.h"

#include "class/counted_angles.h"
#include "class/entry_faults.h"
#include "class/exchanged_rows.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Places with the same fault that are named; letters that the faults of a part take at most.
enum { MOST_NAMED = 3, LONGEST_FAULTS = 320 };
/// Wrong entries of a part in which symbols are exchanged for others: a large matrix has thousands.
enum { MOST_SEARCHED = 40 };
/// Difference that is allowed, relative to the largest entry of the part: the two programs round in
/// another order, and a student may divide where we multiply.
static const double ALLOWED = 1e-9;
/// An entry this small beside its terms has lost four digits; a difference of 1e-13 of the terms,
/// some hundred roundings, is allowed there.
static const double CANCELS = 1e-4;

// ---- what is expected ----

/// The largest number that rounds on the way to entry i: of its terms, 1 where they are not known.
static double terms_size(const hn_export_exam *exam, int part, int i) {
    const hn_export_sum *sum = &exam->sum[part][i];
    double size = 0;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int m = 0; m < sum->n; m++) {
            size = fmax(size, fabs(sum->t[m][k]));
        }
        if (sum->n == 0 && exam->question[k].answer[part][i] != 0) {
            size = 1;
        }
    }
    return size;
}

bool hn_filled_part_is_asked(const hn_export_exam *exam, hn_export_part part) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < exam->size[part]; i++) {
            if (fabs(exam->question[k].answer[part][i]) > ALLOWED * terms_size(exam, part, i)) {
                return true;
            }
        }
    }
    return false; // all zero, rounding aside: nothing is to be filled in
}

/// Returns what a difference in a part is measured by: its largest entry, whatever its unit; where
/// its terms cancel, what they round to.
static double size_of(const hn_export_exam *exam, int part) {
    double size = 0;
    for (int i = 0; i < exam->size[part]; i++) {
        size = fmax(size, CANCELS * terms_size(exam, part, i));
        for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
            size = fmax(size, fabs(exam->question[k].answer[part][i]));
        }
    }
    return size;
}

// ---- comparing ----

/// One part over all states: what is expected and what was given.
typedef struct part_view {
    const hn_export_exam *exam;
    const hn_scene *scene;
    const hn_filled_answers *given;
    int part, offset;
    double size; ///< what differences are measured by
} part_view;

static double expected_at(const part_view *p, int k, int i) {
    return p->exam->question[k].answer[p->part][i];
}

static double given_at(const part_view *p, int k, int i) {
    return p->given->value[k * p->given->n + p->offset + i];
}

static double force_at_rest(const part_view *p, int k, int i) {
    return p->exam->question[k].still[i];
}

static double negative_at(const part_view *p, int k, int i) {
    return -expected_at(p, k, i);
}

static double zero_at(const part_view *p, int k, int i) {
    (void)p, (void)k, (void)i;
    return 0;
}

/// The lower triangle of a symmetric matrix, where the upper one was left out.
static double lower_at(const part_view *p, int k, int i) {
    const int n = p->exam->nv;
    return i % n > i / n ? 0 : expected_at(p, k, i);
}

static double upper_at(const part_view *p, int k, int i) {
    const int n = p->exam->nv;
    return i % n < i / n ? 0 : expected_at(p, k, i);
}

/// The matrix written column by column, as its transpose is.
static double transposed_at(const part_view *p, int k, int i) {
    const int columns = p->exam->columns[p->part], rows = p->exam->size[p->part] / columns;
    return expected_at(p, k, i % rows * columns + i / rows);
}

/// Returns whether every given entry is what `like` says; the largest difference is at *state,
/// *entry.
static bool is_like(const part_view *p, double (*like)(const part_view *, int, int), int *state,
                    int *entry) {
    double worst = -1;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < p->exam->size[p->part]; i++) {
            const double d = fabs(given_at(p, k, i) - like(p, k, i));
            if (!(d <= worst)) {
                worst = isnan(d) ? HUGE_VAL : d;
                *state = k;
                *entry = i;
            }
        }
    }
    return worst <= ALLOWED * p->size;
}

/// The factor by which every entry is off, 0: there is none.
static double factor_of(const part_view *p) {
    double above = 0, below = 0, worst = 0;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < p->exam->size[p->part]; i++) {
            above += given_at(p, k, i) * expected_at(p, k, i);
            below += expected_at(p, k, i) * expected_at(p, k, i);
        }
    }
    const double factor = above / below;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < p->exam->size[p->part]; i++) {
            worst = fmax(worst, fabs(given_at(p, k, i) - factor * expected_at(p, k, i)));
        }
    }
    return worst <= ALLOWED * p->size ? factor : 0;
}

static const struct {
    const char *id, *text;
    bool parts[HN_EXPORT_PARTS]; ///< of which it is a mistake
    double (*like)(const part_view *, int, int);
} MISTAKES[] = {{"empty",
                 "every entry is zero: this part was not filled in",
                 {true, true, true, true},
                 zero_at},
                {"sign", "every entry has the wrong sign", {true, true, true, true}, negative_at},
                {"transposed",
                 "the matrix is transposed: one row for each constraint, one column for each "
                 "velocity",
                 {false, false, true, false},
                 transposed_at},
                {"velocity",
                 "the terms of the velocities, C v, are missing",
                 {false, true, false, false},
                 force_at_rest},
                {"symmetry",
                 "the entries above the diagonal are missing",
                 {true, false, false, false},
                 lower_at},
                {"symmetry",
                 "the entries below the diagonal are missing",
                 {true, false, false, false},
                 upper_at}};

static void name_mistake(const part_view *p, hn_entry_verdict *e) {
    int state, entry;
    for (size_t i = 0; i < sizeof MISTAKES / sizeof *MISTAKES; i++) {
        if (MISTAKES[i].parts[p->part] && is_like(p, MISTAKES[i].like, &state, &entry)) {
            e->mistake = MISTAKES[i].id;
            snprintf(e->explanation, sizeof e->explanation, "%s", MISTAKES[i].text);
            return;
        }
    }
    // no mistake explains a number that is none
    const bool is_number = is_like(p, given_at, &state, &entry);
    const double factor = is_number ? factor_of(p) : 0;
    if (factor != 0) {
        e->mistake = "factor";
        snprintf(e->explanation, sizeof e->explanation, "every entry is %.6g times the right one",
                 factor);
    }
}

/// "force[0]" as the student's language counts.
static void name_entry(const part_view *p, const hn_language *language, int entry, char out[64]) {
    const int columns = p->exam->columns[p->part], first = language->first;
    const char *name = hn_export_part_name((hn_export_part)p->part);
    if (columns) {
        snprintf(out, 64, "%s[%d, %d]", name, entry / columns + first, entry % columns + first);
    } else {
        snprintf(out, 64, "%s[%d]", name, entry + first);
    }
}

/// The entry with the largest difference, as the student's language counts.
static void show_entry(const part_view *p, const hn_language *language, int state, int entry,
                       hn_entry_verdict *e) {
    e->state = state;
    e->given_value = given_at(p, state, entry);
    e->expected_value = expected_at(p, state, entry);
    e->allowed = ALLOWED * p->size;
    char place[64];
    name_entry(p, language, entry, place);
    snprintf(e->given, sizeof e->given, "%s", place);
    snprintf(e->expected, sizeof e->expected, "%s", place);
    if (!isfinite(e->given_value)) {
        e->mistake = "number";
        snprintf(e->explanation, sizeof e->explanation,
                 "%s is not a finite number at state %d of %d (t = %.4g s)", place, state + 1,
                 HN_EXPORT_EXAM_STATES, p->exam->question[state].t);
    } else if (!e->mistake[0]) {
        e->mistake = "other";
        snprintf(e->explanation, sizeof e->explanation,
                 "no known mistake; %s differs most, at state %d of %d (t = %.4g s)", place,
                 state + 1, HN_EXPORT_EXAM_STATES, p->exam->question[state].t);
    }
}

/// Returns whether entry i is right at every state.
static bool is_right(const part_view *p, int i) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(given_at(p, k, i) - expected_at(p, k, i)) <= ALLOWED * p->size)) {
            return false;
        }
    }
    return true;
}

static hn_entry_faults find_faults(const part_view *p, int i, bool thorough) {
    hn_entry_values entry = {.exam = p->exam,
                             .part = (hn_export_part)p->part,
                             .i = i,
                             .sum = &p->exam->sum[p->part][i],
                             .allowed = ALLOWED * p->size,
                             .scene = p->scene,
                             .thorough = thorough};
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        entry.right[k] = expected_at(p, k, i);
        entry.given[k] = given_at(p, k, i);
    }
    return hn_entry_faults_find(&entry);
}

/// Credit of the entries of a part together.
typedef struct part_credit {
    int asked, right;        ///< entries that are not 0 everywhere; those that are right
    double share;            ///< of the points
    int n;                   ///< wrong entries, but for those that are left at 0
    int *entry;              ///< n; owned
    hn_entry_faults *faults; ///< n; owned
    int *same;               ///< n, the first that is wrong for the same reason; owned
} part_credit;

/// Returns whether `value` is 0 in entry i at every state, rounding aside.
static bool is_zero_entry(const part_view *p, int i, double (*value)(const part_view *, int, int)) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(value(p, k, i)) <= ALLOWED * p->size)) {
            return false;
        }
    }
    return true;
}

/// Finds the first entry with the same explanations for each.
static void find_same(part_credit *c) {
    for (int i = 0; i < c->n; i++) {
        const hn_entry_faults *own = &c->faults[i];
        c->same[i] = i;
        for (int k = 0; k < i && c->same[i] == i; k++) {
            const hn_entry_faults *other = &c->faults[k];
            bool same = c->same[k] == k && own->n == other->n && own->found == other->found;
            for (int m = 0; m < own->n && same; m++) {
                same = strcmp(own->fault[m].says, other->fault[m].says) == 0;
            }
            c->same[i] = same ? k : i;
        }
    }
}

/// Entries count alike; one that is 0 everywhere gives nothing, but takes as much if it is wrong.
/// Fails: HN_ERR_MEMORY. free_credit() in any case.
static hn_status credit_part(const part_view *p, part_credit *c) {
    const int size = p->exam->size[p->part];
    double sum = 0;
    *c = (part_credit){.entry = calloc((size_t)size + 1, sizeof *c->entry),
                       .faults = calloc((size_t)size + 1, sizeof *c->faults),
                       .same = calloc((size_t)size + 1, sizeof *c->same)};
    if (!c->entry || !c->faults || !c->same) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < size; i++) {
        const bool is_zero = is_zero_entry(p, i, expected_at), right = is_right(p, i);
        c->asked += !is_zero;
        c->right += !is_zero && right;
        if (right || is_zero) {
            sum += is_zero ? -(double)!right : 1;
        } else if (!is_zero_entry(p, i, given_at)) { // nothing written has no fault of its own
            c->faults[c->n] = find_faults(p, i, c->n < MOST_SEARCHED);
            c->entry[c->n++] = i;
        }
    }
    hn_entry_faults_rank(c->faults, c->n);
    find_same(c);
    for (int i = 0; i < c->n; i++) {
        sum += c->faults[i].share;
    }
    c->share = c->asked > 0 && sum > 0 ? sum / c->asked : 0;
    return HN_OK;
}

static void free_credit(part_credit *c) {
    free(c->entry);
    free(c->faults);
    free(c->same);
    *c = (part_credit){0};
}

/// Adds the entries with the faults of entry i, from it on: "mass[0, 1], mass[1, 0]".
static void put_places(hn_strbuf *b, const part_view *p, const hn_language *language,
                       const part_credit *c, int i) {
    int n = 0;
    for (int k = i; k < c->n; k++) {
        if (c->same[k] == i && n++ < MOST_NAMED) {
            char place[64];
            name_entry(p, language, c->entry[k], place);
            hn_strbuf_printf(b, "%s%s", n > 1 ? ", " : "", place);
        }
    }
    if (n > MOST_NAMED) {
        hn_strbuf_printf(b, " and %d more", n - MOST_NAMED);
    }
}

/// The faults of the wrong entries, as many as have room, where no mistake of the whole part is
/// known.
static void name_entry_faults(const part_view *p, const hn_language *language, const part_credit *c,
                              hn_entry_verdict *e) {
    hn_strbuf all, one;
    hn_strbuf_init(&all);
    hn_strbuf_init(&one);
    const int named = c->n < MOST_NAMED ? c->n : MOST_NAMED;
    const char *mistake = "";
    for (int i = 0; i < c->n && !e->mistake[0]; i++) {
        if (c->faults[i].n == 0 || c->same[i] != i) {
            continue;
        }
        mistake = mistake[0] ? mistake : hn_entry_faults_id(&c->faults[i]);
        hn_strbuf_clear(&one);
        hn_strbuf_add(&one, all.n > 0 ? "; " : "");
        put_places(&one, p, language, c, i);
        hn_strbuf_add(&one, ": ");
        hn_entry_faults_put(&one, &c->faults[i], LONGEST_FAULTS / named - (int)one.n);
        // what would be cut off is left out
        if (all.n + one.n <= LONGEST_FAULTS) {
            hn_strbuf_add(&all, hn_strbuf_text(&one));
        }
    }
    if (all.n > 0) {
        e->mistake = mistake;
        snprintf(e->explanation, sizeof e->explanation, "%s", hn_strbuf_text(&all));
    }
    hn_strbuf_reset(&all);
    hn_strbuf_reset(&one);
}

/// Names angles that are counted otherwise than the scene counts them, where no other mistake of
/// the whole part is known.
static hn_status name_angles(const part_view *p, hn_entry_verdict *e) {
    const int size = p->exam->size[p->part];
    double *values = calloc(HN_EXPORT_EXAM_STATES * (size_t)size + 1, sizeof *values);
    hn_status status = values ? HN_OK : HN_ERR_MEMORY;
    for (int i = 0; i < HN_EXPORT_EXAM_STATES * size && status == HN_OK; i++) {
        values[i] = given_at(p, i / size, i % size);
    }
    const hn_given_part part = {p->exam, (hn_export_part)p->part, values, ALLOWED * p->size};
    char says[HN_COUNTED_ANGLES_TEXT];
    bool found = false;
    if (status == HN_OK && !e->mistake[0]) {
        status = hn_counted_angles_find(&part, &found, says);
    }
    if (status == HN_OK && found) {
        e->mistake = "angle-origin";
        snprintf(e->explanation, sizeof e->explanation, "%s", says);
    }
    free(values);
    return status;
}

/// Names rows or columns in another order, where no other mistake of the whole part is known.
static hn_status name_exchange(const part_view *p, const hn_language *language,
                               hn_entry_verdict *e) {
    const int size = p->exam->size[p->part];
    const int columns = p->exam->columns[p->part] ? p->exam->columns[p->part] : 1;
    double *values = calloc(2 * HN_EXPORT_EXAM_STATES * (size_t)size + 1, sizeof *values);
    if (!values) {
        return HN_ERR_MEMORY;
    }
    double *right = values + HN_EXPORT_EXAM_STATES * (size_t)size;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < size; i++) {
            values[k * size + i] = given_at(p, k, i);
            right[k * size + i] = expected_at(p, k, i);
        }
    }
    const hn_two_matrices m = {.given = values,
                               .right = right,
                               .states = HN_EXPORT_EXAM_STATES,
                               .rows = size / columns,
                               .columns = columns,
                               .allowed = ALLOWED * p->size};
    char says[96];
    if (!e->mistake[0] && hn_exchanged_rows_find(&m, language->first, says)) {
        e->mistake = "exchanged";
        snprintf(e->explanation, sizeof e->explanation, "%s", says);
    }
    free(values);
    return HN_OK;
}

/// Fails: HN_ERR_MEMORY.
static hn_status compare_part(const part_view *p, const hn_language *language,
                              hn_entry_verdict *e) {
    int state = 0, entry = 0;
    snprintf(e->name, sizeof e->name, "%s", hn_export_part_name((hn_export_part)p->part));
    e->n_whole = (int)strlen(e->name);
    e->max_points = HN_FILLED_POINTS;
    e->mistake = "";
    e->state = -1;
    e->right = is_like(p, expected_at, &state, &entry);
    e->points = HN_FILLED_POINTS;
    if (e->right) {
        return HN_OK;
    }

    // hundredths of a point: a share is no more exact than the rubric
    part_credit credit;
    hn_status status = credit_part(p, &credit);
    e->points = round(100 * HN_FILLED_POINTS * credit.share) / 100;
    name_mistake(p, e);
    HN_THEN(status, name_exchange(p, language, e));
    HN_THEN(status, name_angles(p, e));
    if (strcmp(e->mistake, "exchanged") == 0 || strcmp(e->mistake, "angle-origin") == 0) {
        // an entry at another place keeps a quarter, as one with a wrong factor does, and one of
        // other angles
        const double share = (credit.right + 0.25 * (credit.asked - credit.right)) / credit.asked;
        e->points = round(100 * HN_FILLED_POINTS * share) / 100;
    }
    name_entry_faults(p, language, &credit, e);
    show_entry(p, language, state, entry, e);
    const size_t n = strlen(e->explanation);
    snprintf(e->explanation + n, sizeof e->explanation - n, "; %d of %d entries are right",
             credit.right, credit.asked);
    free_credit(&credit);
    return status;
}

/// Returns whether an entry that is asked has the symbol.
static bool is_in_parts(const hn_export_exam *exam, int symbol) {
    const hn_graph *g = hn_system_graph(exam->e.sys);
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        const hn_ex *entry = hn_export_exam_entry(exam, (hn_export_part)part);
        for (int i = 0; i < exam->size[part]; i++) {
            if (hn_depends_on(g, entry[i], symbol)) {
                return true;
            }
        }
    }
    return false;
}

/// Names the parameters that are 0, whose terms no number shows: a term that is left out, or has
/// the wrong sign, is as good as the right one.
static void note_zeros(const hn_filled_exam *f, hn_verdict *v) {
    char names[HN_GRADE_TEXT / 2] = "", first[64] = "";
    size_t n = 0;
    for (int i = 0; i < f->scene->n_params; i++) {
        const hn_param *p = &f->scene->params[i];
        const int symbol = hn_graph_find_symbol(hn_system_graph(f->exam.e.sys), p->name);
        if (p->value == 0 && symbol >= 0 && is_in_parts(&f->exam, symbol) &&
            n + strlen(p->name) + 8 < sizeof names) {
            n += (size_t)snprintf(names + n, sizeof names - n, "%s%s = 0", n ? ", " : "", p->name);
            if (!first[0]) {
                snprintf(first, sizeof first, "%.60s", p->name);
            }
        }
    }
    if (n > 0) {
        snprintf(v->note, sizeof v->note,
                 "terms that are zero for %s were not compared; export and grade with '--set "
                 "%s=...' compare them",
                 names, first);
    }
}

hn_status hn_filled_parts_compare(const hn_filled_exam *f, const hn_language *language,
                                  const hn_filled_answers *given, hn_verdict *v) {
    part_view p = {.exam = &f->exam, .scene = f->scene, .given = given};
    hn_status status = HN_OK;
    for (; p.part < HN_EXPORT_PARTS; p.offset += f->exam.size[p.part++]) {
        if (hn_filled_part_is_asked(&f->exam, (hn_export_part)p.part)) {
            p.size = size_of(&f->exam, p.part);
            hn_entry_verdict *e = &v->entry[v->n_entries];
            e->row = v->n_entries++;
            HN_THEN(status, compare_part(&p, language, e));
            v->n_right += e->right;
            v->score += e->points;
        }
    }
    v->n_states = HN_EXPORT_EXAM_STATES;
    snprintf(v->summary, sizeof v->summary, "%d of %d parts are right", v->n_right, v->n_entries);
    note_zeros(f, v);
    return status;
}
