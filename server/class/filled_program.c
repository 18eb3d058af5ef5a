// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // mkstemps
#include "class/filled_program.h"

#include "base/file.h"
#include "base/hash.h"
#include "class/entry_faults.h"
#include "class/filled_origin.h"
#include "export/language.h"
#include "grade/submission.h"
#include "program/guest_process.h"
#include "program/sandbox.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const double POINTS = 2; // of a part
/// Wrong entries of a part whose faults are named; letters that these take at most.
enum { MOST_NAMED = 3, LONGEST_FAULTS = 320 };
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

static bool is_asked(const hn_export_exam *exam, int part) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        for (int i = 0; i < exam->size[part]; i++) {
            if (fabs(exam->question[k].answer[part][i]) > ALLOWED * terms_size(exam, part, i)) {
                return true;
            }
        }
    }
    return false; // all zero, rounding aside: nothing is to be filled in
}

/// What a difference in a part is measured by: its largest entry, whatever its unit; where its
/// terms cancel, what they round to.
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

hn_status hn_filled_exam_init(hn_filled_exam *f, const hn_model *model, hn_diags *diags) {
    const hn_walk_limits none = {0};
    hn_diag diag = {0};
    *f = (hn_filled_exam){.scene = hn_model_scene(model)};
    if (hn_sandbox_check(&diag) != HN_OK) {
        return hn_diags_add(diags, diag.status, NULL, diag.hint, "%s", diag.message);
    }
    HN_TRY(hn_export_exam_init(&f->exam, model, &none, diags));

    // an exercise that no file describes
    const hn_scene *scene = hn_model_scene(model);
    snprintf(f->title, sizeof f->title, "the program of %s",
             scene->title ? scene->title : scene->id);
    f->exercise =
        (hn_exercise){.id = scene->id, .title = f->title, .scene = "", .hash = scene->hash};
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        f->exercise.n_parts += is_asked(&f->exam, part);
    }
    f->exercise.points = POINTS * f->exercise.n_parts;
    return HN_OK;
}

void hn_filled_exam_reset(hn_filled_exam *f) {
    hn_export_exam_reset(&f->exam);
}

static const hn_language *language_of(const char *path) {
    int n;
    const hn_language *all = hn_languages(&n);
    const char *dot = strrchr(path, '.');
    for (int i = 0; dot && i < n; i++) {
        if (strcasecmp(dot, all[i].suffix) == 0 && strcmp(all[i].suffix, ".wl") != 0 &&
            strcmp(all[i].suffix, ".mo") != 0 && strcmp(all[i].suffix, ".tex") != 0) {
            return &all[i];
        }
    }
    return NULL;
}

bool hn_filled_program_is(const char *path) {
    return language_of(path) != NULL;
}

bool hn_filled_program_has_lines(const char *path) {
    const hn_language *language = language_of(path);
    return language && !strchr(language->constant, ';');
}

// ---- asking ----

/// What a program has answered: for each state all parts behind each other.
typedef struct answers {
    int n; ///< numbers a state
    double *value;
} answers;

/// Sends one state and reads the numbers of its answer.
static hn_status ask(const hn_export_exam *exam, hn_guest_process *process, int k, double seconds,
                     answers *out, hn_diag *diag) {
    const hn_export_question *question = &exam->question[k];
    hn_strbuf text, line;
    hn_strbuf_init(&text);
    hn_strbuf_init(&line);
    hn_strbuf_printf(&text, "%.17g", question->t);
    for (int i = 0; i < exam->nq + exam->nv; i++) {
        hn_strbuf_printf(&text, " %.17g",
                         i < exam->nq ? question->q[i] : question->v[i - exam->nq]);
    }
    hn_strbuf_add(&text, "\n");
    hn_status status =
        hn_guest_process_ask(process, hn_strbuf_text(&text), text.n, seconds, &line, diag);

    // as many numbers as the parts have entries
    const char *at = hn_strbuf_text(&line);
    int n = 0;
    for (; status == HN_OK && n < out->n; n++) {
        char *end;
        out->value[k * out->n + n] = strtod(at, &end);
        if (end == at) {
            break;
        }
        at = end;
    }
    if (status == HN_OK && (n < out->n || at[strspn(at, " ")] != '\0')) {
        status = hn_diag_set(
            diag, HN_ERR_INPUT, NULL,
            "hand in the file of 'export SCENE --blanks', filled in; no other program answers, and "
            "it prints nothing of your own",
            "its answer to state %d is not the %d numbers of its parts, but '%.40s'", k + 1, out->n,
            hn_strbuf_text(&line));
    }
    hn_strbuf_reset(&text);
    hn_strbuf_reset(&line);
    return status;
}

static hn_status ask_all(const hn_export_exam *exam, const char *path, answers *out,
                         hn_diag *diag) {
    const hn_program_limits limits = hn_program_limits_default();
    hn_sandbox_command command;
    hn_guest_process process;
    HN_TRY(hn_sandbox_build(&command, path, "states", false, &limits, diag));
    HN_TRY(hn_guest_process_start(&process, command.argv, command.file, &limits, diag));
    hn_status status = HN_OK;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES && status == HN_OK; k++) {
        status = ask(exam, &process, k, k == 0 ? limits.start : limits.answer, out, diag);
    }
    hn_guest_process_end(&process);
    return status;
}

// ---- comparing ----

/// One part over all states: what is expected and what was given.
typedef struct part_view {
    const hn_export_exam *exam;
    const hn_scene *scene;
    const answers *given;
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

/// Whether every given entry is what `like` says; the largest difference is at *state, *entry.
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

/// Whether entry i is right at every state.
static bool is_right(const part_view *p, int i) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(given_at(p, k, i) - expected_at(p, k, i)) <= ALLOWED * p->size)) {
            return false;
        }
    }
    return true;
}

static hn_entry_faults find_faults(const part_view *p, int i) {
    hn_entry_values entry = {.sum = &p->exam->sum[p->part][i],
                             .allowed = ALLOWED * p->size,
                             .is_mass = p->part == HN_EXPORT_MASS,
                             .scene = p->scene};
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        entry.right[k] = expected_at(p, k, i);
        entry.given[k] = given_at(p, k, i);
    }
    return hn_entry_faults_find(&entry);
}

/// What the entries of a part are worth together.
typedef struct part_credit {
    int asked, right; ///< entries that are not 0 everywhere; those that are right
    double share;     ///< of the points
    int named;        ///< wrong entries with a known fault, the first of which are kept
    int entry[MOST_NAMED];
    hn_entry_faults faults[MOST_NAMED];
} part_credit;

/// Whether `value` is 0 in entry i at every state, rounding aside.
static bool is_zero_entry(const part_view *p, int i, double (*value)(const part_view *, int, int)) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(value(p, k, i)) <= ALLOWED * p->size)) {
            return false;
        }
    }
    return true;
}

/// Entries count alike; one that is 0 everywhere gives nothing, but takes as much if it is wrong.
static part_credit credit_part(const part_view *p) {
    part_credit c = {0};
    double sum = 0;
    for (int i = 0; i < p->exam->size[p->part]; i++) {
        const bool is_zero = is_zero_entry(p, i, expected_at), right = is_right(p, i);
        c.asked += !is_zero;
        c.right += !is_zero && right;
        if (right || is_zero) {
            sum += is_zero ? -(double)!right : 1;
            continue;
        }
        if (is_zero_entry(p, i, given_at)) {
            continue; // nothing was written, which has no fault of its own
        }
        const hn_entry_faults faults = find_faults(p, i);
        const double share = hn_entry_faults_share(&faults);
        sum += share;
        if (share > 0 && c.named < MOST_NAMED) {
            c.entry[c.named] = i;
            c.faults[c.named++] = faults;
        }
    }
    c.share = c.asked > 0 && sum > 0 ? sum / c.asked : 0;
    return c;
}

/// The faults of the first wrong entries, where no mistake of the whole part is known.
static void name_entry_faults(const part_view *p, const hn_language *language, const part_credit *c,
                              hn_entry_verdict *e) {
    if (e->mistake[0]) {
        return;
    }
    hn_strbuf all;
    hn_strbuf_init(&all);
    for (int i = 0; i < c->named; i++) {
        char place[64];
        hn_strbuf one;
        hn_strbuf_init(&one);
        name_entry(p, language, c->entry[i], place);
        hn_strbuf_printf(&one, "%s%s: ", i > 0 ? "; " : "", place);
        hn_entry_faults_put(&one, &c->faults[i]);
        // what would be cut off is left out
        if (i == 0 || all.n + one.n < LONGEST_FAULTS) {
            hn_strbuf_add(&all, hn_strbuf_text(&one));
        }
        hn_strbuf_reset(&one);
    }
    if (c->named > 0) {
        e->mistake = hn_entry_faults_id(&c->faults[0]);
        snprintf(e->explanation, sizeof e->explanation, "%.*s", LONGEST_FAULTS,
                 hn_strbuf_text(&all));
    }
    hn_strbuf_reset(&all);
}

static void compare_part(const part_view *p, const hn_language *language, hn_entry_verdict *e) {
    int state = 0, entry = 0;
    snprintf(e->name, sizeof e->name, "%s", hn_export_part_name((hn_export_part)p->part));
    e->n_whole = (int)strlen(e->name);
    e->max_points = POINTS;
    e->mistake = "";
    e->state = -1;
    e->right = is_like(p, expected_at, &state, &entry);
    e->points = POINTS;
    if (!e->right) {
        // hundredths of a point: a share is no more exact than the rubric
        const part_credit credit = credit_part(p);
        e->points = round(100 * POINTS * credit.share) / 100;
        name_mistake(p, e);
        name_entry_faults(p, language, &credit, e);
        show_entry(p, language, state, entry, e);
        const size_t n = strlen(e->explanation);
        snprintf(e->explanation + n, sizeof e->explanation - n, "; %d of %d entries are right",
                 credit.right, credit.asked);
    }
}

static void compare_all(const hn_filled_exam *f, const hn_language *language, const answers *given,
                        hn_verdict *v) {
    part_view p = {.exam = &f->exam, .scene = f->scene, .given = given};
    for (; p.part < HN_EXPORT_PARTS; p.offset += f->exam.size[p.part++]) {
        if (is_asked(&f->exam, p.part)) {
            p.size = size_of(&f->exam, p.part);
            hn_entry_verdict *e = &v->entry[v->n_entries];
            e->row = v->n_entries++;
            compare_part(&p, language, e);
            v->n_right += e->right;
            v->score += e->points;
        }
    }
    v->n_states = HN_EXPORT_EXAM_STATES;
    snprintf(v->summary, sizeof v->summary, "%d of %d parts are right", v->n_right, v->n_entries);
}

// ---- the whole ----

static void keep_program(hn_graded_program *kept, const char *path, const hn_strbuf *text) {
    const char *slash = strrchr(path, '/');
    snprintf(kept->file, sizeof kept->file, "%.79s", slash ? slash + 1 : path);
    hn_strbuf_clear(&kept->text);
    hn_strbuf_add_n(&kept->text, hn_strbuf_text((hn_strbuf *)text), text->n);
}

hn_status hn_filled_program_grade_text(const hn_filled_exam *f, const char *name, const char *text,
                                       size_t n, hn_verdict *v) {
    const char *dot = hn_filled_program_is(name) ? strrchr(name, '.') : "";
    const char *folder = getenv("TMPDIR");
    char path[1024];
    snprintf(path, sizeof path, "%.900s/holonom-XXXXXX%.8s", folder ? folder : "/tmp", dot);
    const int fd = mkstemps(path, (int)strlen(dot));
    if (fd < 0) {
        return HN_ERR_IO;
    }
    const bool written = write(fd, text, n) == (ssize_t)n;
    close(fd);
    const hn_status status = written ? hn_filled_program_grade(f, path, NULL, v) : HN_ERR_IO;
    unlink(path);
    return status;
}

hn_status hn_filled_program_grade(const hn_filled_exam *f, const char *path,
                                  hn_graded_program *kept, hn_verdict *v) {
    const hn_language *language = language_of(path);
    hn_diag diag = {0}, origin = {0};
    hn_strbuf text;
    memset(v, 0, sizeof *v);
    v->problem = &f->exercise;
    v->max_score = f->exercise.points;
    v->shown_entry = -1;
    if (!language) {
        hn_submission_refuse(v, "hand in the file that export --blanks wrote, filled in",
                             "its name does not end in .py, .c, .cpp, .java, .m or .jl");
        return HN_OK;
    }

    // the text is kept for who asks for it, else as its hash alone
    hn_strbuf_init(&text);
    hn_status status = hn_file_read(path, HN_GRADE_MAX_BYTES, &text, &diag);
    v->submission_hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, hn_strbuf_text(&text), text.n));
    if (status == HN_OK && strspn(hn_strbuf_text(&text), " \t\r\n") == text.n) {
        status = hn_diag_set(&diag, HN_ERR_INPUT, NULL,
                             "hand in the file that export --blanks wrote, filled in",
                             "the file is empty");
    }
    if (kept) {
        keep_program(kept, path, &text);
        v->program = kept;
    }
    const bool is_other = hn_filled_origin_check(f->scene, hn_strbuf_text(&text), &origin) != HN_OK;
    hn_strbuf_reset(&text);

    // its answers, compared part by part
    answers given = {0};
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        given.n += f->exam.size[part];
    }
    given.value = calloc((size_t)given.n * HN_EXPORT_EXAM_STATES, sizeof *given.value);
    if (!given.value) {
        return HN_ERR_MEMORY;
    }
    HN_THEN(status, ask_all(&f->exam, path, &given, &diag));
    if (status == HN_OK) {
        compare_all(f, language, &given, v);
    } else {
        hn_submission_refuse(v, diag.hint, "%s", diag.message);
    }
    free(given.value);

    // numbers of another scene or other parameters say nothing about what was filled in
    if (is_other && (status != HN_OK || v->n_right < v->n_entries)) {
        v->n_entries = v->n_right = 0;
        v->score = 0;
        v->summary[0] = '\0';
        hn_submission_refuse(v, origin.hint, "%s", origin.message);
    }
    return HN_OK;
}
