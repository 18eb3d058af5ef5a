// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/verdict.h"

#include "base/hash.h"
#include "build.h"
#include "grade/rubric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TERMINAL_COLUMNS = 80 };

/// "at        l1 = 1.2, ..., th4 = -0.3": the state of an entry, in lines of 80 columns.
static void add_state(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e,
                      const char *indent) {
    static const char HEAD[] = "at        ";
    const int margin = (int)(strlen(indent) + strlen(HEAD));
    int column = margin;
    hn_strbuf_printf(b, "%s%s", indent, HEAD);
    for (int i = 0; i < v->n_names; i++) {
        char text[64];
        const int n = snprintf(text, sizeof text, "%s = %.6g%s", v->names[i], e->at[i],
                               i < v->n_names - 1 ? "," : "");
        if (i > 0 && column + 1 + n > TERMINAL_COLUMNS) {
            hn_strbuf_printf(b, "\n%*s", margin, "");
            column = margin;
        } else if (i > 0) {
            hn_strbuf_add(b, " ");
            column++;
        }
        hn_strbuf_add(b, text);
        column += n;
    }
    hn_strbuf_add(b, "\n");
}

static void add_number(hn_strbuf *b, double x) {
    if (isfinite(x)) {
        hn_strbuf_printf(b, "%.9g", x);
    } else {
        hn_strbuf_add(b, "no finite value");
    }
}

/// Returns whether an answer is a number as it stands, and no formula that has a value.
static bool is_number(const char *given) {
    char *end;
    strtod(given, &end);
    return end != given && !end[strspn(end, " ")];
}

void hn_verdict_given(hn_strbuf *b, const hn_entry_verdict *e) {
    hn_strbuf_add(b, e->given);
    if (e->state >= 0 && !is_number(e->given)) {
        hn_strbuf_add(b, " = ");
        add_number(b, e->given_value);
    }
}

bool hn_verdict_shows_expected(const hn_verdict *v, const hn_entry_verdict *e) {
    return v->show_expected && !e->right &&
           (e->state >= 0 || (e->expected[0] && e->max_points > 0));
}

void hn_verdict_expected(hn_strbuf *b, const hn_entry_verdict *e) {
    hn_strbuf_add(b, e->expected);
    if (e->state >= 0 && !is_number(e->expected)) {
        hn_strbuf_add(b, " = ");
        add_number(b, e->expected_value);
    }
}

void hn_verdict_entry_text(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e,
                           const char *indent) {
    if (e->explanation[0]) {
        hn_strbuf_printf(b, "%s%s\n", indent, e->explanation);
    }
    const bool shows = hn_verdict_shows_expected(v, e);
    if (e->right || (!e->given[0] && !shows)) {
        return;
    }
    if (e->given[0]) {
        hn_strbuf_printf(b, "%sgiven     ", indent);
        hn_verdict_given(b, e);
    }
    if (shows) {
        hn_strbuf_printf(b, "%s%sexpected  ", e->given[0] ? "\n" : "", indent);
        hn_verdict_expected(b, e);
    }
    if (shows && e->state >= 0) {
        hn_strbuf_printf(b, ", a difference of %.2g is allowed", e->allowed);
    } else if (e->state >= 0) {
        hn_strbuf_printf(b, ", off by more than the %.2g allowed", e->allowed);
    }
    hn_strbuf_add(b, "\n");
    if (e->state >= 0 && v->n_names > 0) {
        add_state(b, v, e, indent);
    }
}

void hn_verdict_text(hn_strbuf *b, const hn_verdict *v) {
    hn_strbuf_printf(b, "%s: %s\n", v->problem->id, v->problem->title);
    if (v->kind == HN_VERDICT_UNGRADABLE) {
        hn_strbuf_printf(b, "cannot be graded: %s\n", v->reason);
        if (v->hint[0]) {
            hn_strbuf_printf(b, "  %s\n", v->hint);
        }
        if (v->note[0]) {
            hn_strbuf_printf(b, "note: %s\n", v->note);
        }
        return;
    }

    // the sum, then entry by entry, in columns
    int widest = 5;
    for (int k = 0; k < v->n_entries; k++) {
        const int width = (int)strlen(v->entry[k].name);
        widest = width > widest ? width : widest;
    }
    hn_strbuf_printf(b, "score %g of %g: %s\n", v->score, v->max_score, v->summary);
    if (v->note[0]) {
        hn_strbuf_printf(b, "note: %s\n", v->note);
    }
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        hn_strbuf_printf(b, "  %-*s %4g / %g  %s\n", widest, e->name, e->points, e->max_points,
                         e->mistake[0] ? e->mistake : "right");
        hn_verdict_entry_text(b, v, e, "        ");
    }
    if (v->n_states > 0 && v->seed == 0) {
        hn_strbuf_printf(b, "compared at %d states of the motion\n", v->n_states);
    } else if (v->n_states > 0) {
        hn_strbuf_printf(b, "compared at %d random states, seed %llu\n", v->n_states,
                         (unsigned long long)v->seed);
    } else {
        hn_strbuf_printf(b, "variant of seed %llu%s%s\n", (unsigned long long)v->seed,
                         v->student[0] ? ", " : "", v->student);
    }
    if (v->problem->rubric) {
        char hash[17];
        hn_hash_hex(hn_rubric_hash(v->problem->rubric), hash);
        hn_strbuf_printf(b, "points and tolerances of the rubric %s (hash %s)\n",
                         hn_rubric_file(v->problem->rubric), hash);
    }
}

const char *hn_verdict_status(const hn_verdict *v) {
    return v->kind == HN_VERDICT_GRADED ? "graded" : v->no_submission ? "failed" : "ungradable";
}

static void put_entry(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e) {
    hn_json_object(b);
    hn_json_put_string(b, "name", e->name);
    hn_json_put_number(b, "points", e->points);
    hn_json_put_number(b, "max_points", e->max_points);
    hn_json_put_bool(b, "right", e->right);
    hn_json_put_bool(b, "closed_only", e->closed_only);
    hn_json_put_string(b, "mistake", e->mistake);
    hn_json_put_string(b, "explanation", e->explanation);
    hn_json_put_string(b, "given", e->given);
    if (v->show_expected) {
        hn_json_put_string(b, "expected", e->expected);
    }
    if (e->state >= 0) {
        hn_json_put_int(b, "state", e->state);
        hn_json_put_number(b, "given_value", e->given_value);
        if (v->show_expected) {
            hn_json_put_number(b, "expected_value", e->expected_value);
        }
        hn_json_put_number(b, "allowed", e->allowed);
    }
    hn_json_end_object(b);
}

/// The scene in the state of the picture: parameters, then coordinates.
static void put_shown(hn_strbuf *b, const hn_verdict *v) {
    const hn_part_view *view = &v->view;
    hn_json_put_string(b, "shown_entry", v->entry[v->shown_entry].name);
    hn_json_put_string(b, "shown_scene", view->scene ? view->scene : v->problem->scene);
    hn_json_key(b, "shown_state");
    hn_json_object(b);
    for (int i = 0; i < v->n_names; i++) {
        hn_json_put_number(b, v->names[i], v->values[i]);
    }
    for (int i = 0; i < view->n_settings; i++) {
        hn_json_put_number(b, view->settings[i].name, view->settings[i].value);
    }
    for (int i = 0; i < view->n_entries; i++) {
        hn_json_put_number(b, view->names[i], view->given[i]);
    }
    hn_json_end_object(b);
}

/// Writes what reproduces the verdict, and the state of the picture.
static void put_origin(hn_strbuf *b, const hn_verdict *v) {
    char hash[17], seed[32];
    hn_hash_hex(v->problem->hash, hash);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)v->seed);

    // the variant that was graded
    hn_json_put_string(b, "problem", v->problem->id);
    if (v->problem->file) {
        hn_json_put_string(b, "problem_file", v->problem->file);
    }
    hn_json_put_string(b, "problem_hash", hash);
    hn_json_put_string(b, "seed", seed); // as text: a program may read numbers as doubles
    hn_json_put_int(b, "states", v->n_states);
    if (v->problem->n_parts > 0) {
        hn_json_put_int(b, "letters", v->problem->first_letters ? 1 : HN_LETTERS);
    }
    if (!v->program) {
        hn_contents_put(b, &v->problem->contents, v->problem->parts);
    }

    if (v->problem->rubric) {
        hn_hash_hex(hn_rubric_hash(v->problem->rubric), hash);
        hn_json_put_string(b, "rubric_hash", hash);
        hn_json_put_string(b, "rubric_file", hn_rubric_file(v->problem->rubric));
    }

    // who handed in what, and which build graded it
    hn_json_put_string(b, "student", v->student);
    hn_json_put_string(b, "build", hn_build_name());
    hn_hash_hex(v->submission_hash, hash);
    hn_json_put_string(b, "submission_hash", hash);

    // the scene in the state where the answer is shown
    if (v->shown_entry >= 0) {
        put_shown(b, v);
    }
}

/// The program, and the parameters of the scene that it was graded with.
static void put_program(hn_strbuf *b, const hn_graded_program *p) {
    hn_json_put_string(b, "submission", hn_strbuf_text((hn_strbuf *)&p->text));
    hn_json_put_string(b, "submission_file", p->file);
    hn_json_key(b, "set");
    hn_json_array(b);
    for (int i = 0; i < p->n_set; i++) {
        hn_json_string(b, p->set[i]);
    }
    hn_json_end_array(b);
}

void hn_verdict_json(hn_strbuf *b, const hn_verdict *v) {
    // what was graded, and the outcome
    hn_json_object(b);
    put_origin(b, v);
    hn_json_put_string(b, "status", hn_verdict_status(v));
    if (v->kind == HN_VERDICT_UNGRADABLE) {
        hn_json_put_string(b, "reason", v->reason);
        hn_json_put_string(b, "hint", v->hint);
    } else {
        hn_json_put_number(b, "score", v->score);
        hn_json_put_string(b, "summary", v->summary);
    }

    // what holds for every outcome
    hn_json_put_number(b, "max_score", v->max_score);
    hn_json_put_string(b, "note", v->note);
    if (v->program) {
        put_program(b, v->program);
    } else {
        hn_json_put_string(b, "submission", v->submission);
    }

    // the verdict on each entry
    hn_json_key(b, "entries");
    hn_json_array(b);
    for (int k = 0; k < v->n_entries; k++) {
        put_entry(b, v, &v->entry[k]);
    }
    hn_json_end_array(b);

    hn_json_end_object(b);
}

static void put_test(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e) {
    char number[32];
    hn_strbuf detail;
    hn_strbuf_init(&detail);
    hn_verdict_entry_text(&detail, v, e, "");

    // the keys are Gradescope's
    snprintf(number, sizeof number, "%d.%d", e->row + 1, e->column + 1);
    hn_json_object(b);
    hn_strbuf name;
    hn_strbuf_init(&name);
    if (v->problem->n_parts) {
        hn_strbuf_printf(&name, "part %s", e->name);
    } else {
        hn_strbuf_printf(&name, "%s = d phi_%d / d %s", e->name, e->row + 1,
                         v->problem->by[e->column]);
    }
    hn_json_put_string(b, "name", hn_strbuf_text(&name));
    hn_json_put_string(b, "number", number);
    hn_json_put_number(b, "score", e->points);
    hn_json_put_number(b, "max_score", e->max_points);
    hn_json_put_string(b, "status", e->points == e->max_points ? "passed" : "failed");
    hn_json_put_string(b, "output", detail.n ? hn_strbuf_text(&detail) : "right");
    hn_json_put_string(b, "output_format", "text");
    hn_json_put_string(b, "visibility", hn_rubric_visibility(v->problem->rubric, e->name));
    hn_json_end_object(b);
    b->failed |= detail.failed | name.failed;
    hn_strbuf_reset(&detail);
    hn_strbuf_reset(&name);
}

/// Writes the sentence on the whole that a student reads at once: where parts are shown later, it
/// counts the entries of the others alone.
static void put_visible_summary(hn_strbuf *b, const hn_verdict *v) {
    int right = 0, visible = 0;
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        if (strcmp(hn_rubric_visibility(v->problem->rubric, e->name), "visible") == 0) {
            visible++;
            right += e->right;
        }
    }
    if (visible == v->n_entries) {
        hn_strbuf_add(b, v->summary);
    } else {
        hn_strbuf_printf(b, "%d of the %d entries that are shown are right", right, visible);
    }
}

void hn_verdict_gradescope(hn_strbuf *b, const hn_verdict *v, double execution_time) {
    int graded = v->kind == HN_VERDICT_GRADED;
    hn_strbuf output;
    hn_strbuf_init(&output);
    if (graded) {
        put_visible_summary(&output, v);
    } else {
        hn_strbuf_printf(&output, "This cannot be graded: %s. %s", v->reason, v->hint);
    }
    if (graded && v->note[0]) {
        hn_strbuf_printf(&output, "\nNote: %s.", v->note);
    }

    // the keys are Gradescope's
    hn_json_object(b);
    hn_json_put_number(b, "score", v->score);
    if (execution_time >= 0) {
        hn_json_put_number(b, "execution_time", execution_time);
    }
    hn_json_put_string(b, "output", hn_strbuf_text(&output));
    hn_json_put_string(b, "output_format", "text");
    hn_json_put_string(b, "test_output_format", "text");
    hn_json_put_string(b, "test_name_format", "text");
    hn_json_put_string(b, "visibility", "visible");
    hn_json_put_string(b, "stdout_visibility", "hidden");

    hn_json_key(b, "tests");
    hn_json_array(b);
    for (int k = 0; k < v->n_entries; k++) {
        put_test(b, v, &v->entry[k]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "extra_data");
    hn_json_object(b);
    hn_json_put_string(b, "status", hn_verdict_status(v));
    put_origin(b, v);
    hn_json_end_object(b);
    hn_json_end_object(b);
    b->failed |= output.failed;
    hn_strbuf_reset(&output);
}
