// SPDX-License-Identifier: GPL-3.0-or-later
// holonom regrade: grades again what a verdict says was handed in, and says what has changed since.
#include "base/file.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "build.h"
#include "class/filled_program.h"
#include "cli/commands/exercise_word.h"
#include "cli/commands/rubric_file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "grade/grade.h"
#include "grade/rubric.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_VERDICT = 4 << 20, MAX_DEPTH = 32 };

static const char *text_of(const cJSON *node, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(node, key));
    return text ? text : "";
}

/// Reads the verdict; NULL with a fault where it is none.
static cJSON *load_verdict(const char *path, hn_diags *diags) {
    hn_strbuf text;
    hn_diag diag = {0};
    cJSON *root = NULL;
    hn_strbuf_init(&text);
    if (hn_file_load(path, MAX_VERDICT, &text, diags) == HN_OK) {
        if (hn_json_text_check(hn_strbuf_text(&text), text.n, MAX_DEPTH, &diag) == HN_OK) {
            root = cJSON_ParseWithLength(hn_strbuf_text(&text), text.n);
        }
        if (!root || !text_of(root, "problem")[0] || !text_of(root, "seed")[0]) {
            hn_diags_add(diags, HN_ERR_INPUT, "", "holonom grade ID FILE --format json",
                         "'%.200s' is no verdict in JSON", path);
            cJSON_Delete(root);
            root = NULL;
        }
    }
    hn_strbuf_reset(&text);
    return root;
}

/// The exercise has changed: what of it, where the verdict says what it was.
static void add_exercise_change(hn_strbuf *b, const cJSON *old, const hn_exercise *e) {
    hn_strbuf what;
    hn_strbuf_init(&what);
    hn_contents_put_changes(&what, &e->contents, e->parts,
                            cJSON_GetObjectItemCaseSensitive(old, "contents"));
    hn_strbuf_printf(b, "the exercise has changed since the verdict%s%s\n", what.n ? ": " : "",
                     hn_strbuf_text(&what));
    b->failed |= what.failed;
    hn_strbuf_reset(&what);
}

/// The entry of this name in the verdict; NULL: none.
static const cJSON *find_entry(const cJSON *old, const char *name) {
    const cJSON *e;
    cJSON_ArrayForEach(e, cJSON_GetObjectItemCaseSensitive(old, "entries")) {
        if (strcmp(text_of(e, "name"), name) == 0) {
            return e;
        }
    }
    return NULL;
}

/// "b: 1 of 2 (sign)"; points that a verdict does not hold are left out.
static void add_judgement(hn_strbuf *b, double points, double most, const char *mistake) {
    if (isfinite(points)) {
        hn_strbuf_printf(b, "%g ", points);
    }
    if (isfinite(points) && isfinite(most)) {
        hn_strbuf_printf(b, "of %g ", most);
    }
    hn_strbuf_printf(b, "(%s)", mistake[0] ? mistake : "right");
}

/// Entries of the verdict that this program does not judge, a line each.
static void add_entries_gone(hn_strbuf *b, const cJSON *old, const hn_verdict *v) {
    const cJSON *e;
    cJSON_ArrayForEach(e, cJSON_GetObjectItemCaseSensitive(old, "entries")) {
        const char *name = text_of(e, "name");
        bool judged = false;
        for (int k = 0; k < v->n_entries && !judged; k++) {
            judged = strcmp(v->entry[k].name, name) == 0;
        }
        if (!judged) {
            hn_strbuf_printf(b, "%.60s is not judged now\n", name);
        }
    }
}

/// Entries that are judged in another way than before, a line each.
static void add_entry_changes(hn_strbuf *b, const cJSON *old, const hn_verdict *v) {
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *now = &v->entry[k];
        const cJSON *then = find_entry(old, now->name);
        const double points = hn_part_number(then, "points", (double)NAN);
        const double most = hn_part_number(then, "max_points", (double)NAN);
        const char *mistake = text_of(then, "mistake");
        if (!then) {
            hn_strbuf_printf(b, "%s was not in the verdict\n", now->name);
        } else if (!(fabs(points - now->points) <= 1e-9) ||
                   !(fabs(most - now->max_points) <= 1e-9) || strcmp(mistake, now->mistake) != 0) {
            hn_strbuf_printf(b, "%s: ", now->name);
            add_judgement(b, points, most, mistake);
            hn_strbuf_add(b, " before, ");
            add_judgement(b, now->points, now->max_points, now->mistake);
            hn_strbuf_add(b, " now\n");
        }
    }
    if (v->n_entries > 0) {
        add_entries_gone(b, old, v);
    }
}

/// "r.toml (hash 0123456789abcdef)", or "none".
static void add_rubric(hn_strbuf *b, const char *file, const char *hash) {
    hn_strbuf_printf(b, "%s%s", file, file[0] ? " " : "");
    hn_strbuf_printf(b, hash[0] ? "(hash %s)" : "none", hash);
}

/// Says what differs between the verdict and this program, a line each.
static void add_changes(hn_strbuf *b, const cJSON *old, const hn_verdict *v) {
    char hash[17];
    hn_hash_hex(v->problem->hash, hash);
    if (strcmp(text_of(old, "problem_hash"), hash) != 0) {
        add_exercise_change(b, old, v->problem);
    }
    hn_hash_hex(hn_rubric_hash(v->problem->rubric), hash);
    if (strcmp(text_of(old, "rubric_hash"), v->problem->rubric ? hash : "") != 0) {
        hn_strbuf_add(b, "the rubric is another one than was used: ");
        add_rubric(b, text_of(old, "rubric_file"), text_of(old, "rubric_hash"));
        hn_strbuf_add(b, " before, ");
        add_rubric(b, hn_rubric_file(v->problem->rubric), v->problem->rubric ? hash : "");
        hn_strbuf_printf(b, " now%s\n", v->problem->rubric ? "" : "; name it with --rubric");
    }
    hn_hash_hex(v->submission_hash, hash);
    if (strcmp(text_of(old, "submission_hash"), hash) != 0) {
        hn_strbuf_add(b, "the submission is another one than was graded\n");
    }
    if (v->problem->first_letters) {
        hn_strbuf_add(b, "options have other letters since; graded by those of the verdict\n");
    }
    if (strcmp(text_of(old, "build"), hn_build_name()) != 0) {
        hn_strbuf_printf(b, "graded by %s, now by %s\n", text_of(old, "build"), hn_build_name());
    }
    if (v->kind == HN_VERDICT_GRADED && strcmp(text_of(old, "status"), "graded") == 0) {
        add_entry_changes(b, old, v);
    }
}

/// The changes as indented lines, or as texts in a list.
static void put_changes(hn_strbuf *b, const cJSON *old, const hn_verdict *v, bool json) {
    hn_strbuf lines;
    hn_strbuf_init(&lines);
    add_changes(&lines, old, v);
    if (json) {
        hn_json_key(b, "changes");
        hn_json_array(b);
    }
    char *rest = NULL, *text = strdup(hn_strbuf_text(&lines));
    for (char *line = text ? strtok_r(text, "\n", &rest) : NULL; line;
         line = strtok_r(NULL, "\n", &rest)) {
        if (json) {
            hn_json_string(b, line);
        } else {
            hn_strbuf_printf(b, "  %s\n", line);
        }
    }
    if (json) {
        hn_json_end_array(b);
    }
    b->failed |= lines.failed || !text;
    free(text);
    hn_strbuf_reset(&lines);
}

/// Both scores, each of its own maximum; a verdict without one says so in its place.
static void put_scores(hn_strbuf *b, const cJSON *old, const hn_verdict *v, bool same) {
    const bool graded = strcmp(text_of(old, "status"), "graded") == 0;
    const double score = hn_part_number(old, "score", (double)NAN);
    const double most = hn_part_number(old, "max_score", v->max_score);
    hn_strbuf_printf(b, "%s, seed %s: ", v->problem->id, text_of(old, "seed"));

    // what could not be graded has no score to compare
    if (v->kind == HN_VERDICT_UNGRADABLE && !graded) {
        hn_strbuf_add(b, "could not be graded before, cannot be graded now\n");
    } else if (v->kind == HN_VERDICT_UNGRADABLE) {
        hn_strbuf_printf(b, "%g of %g before, cannot be graded now\n", score, most);
    } else if (!graded) {
        hn_strbuf_printf(b, "could not be graded before, %g of %g now\n", v->score, v->max_score);
    } else {
        hn_strbuf_printf(b, "%s: %g of %g before, %g of %g now\n",
                         same ? "the same score" : "ANOTHER SCORE", score, most, v->score,
                         v->max_score);
    }
}

/// Returns whether both were graded, or neither, and with the same score of the same maximum, up to
/// the rounding of their text.
static bool is_same(const cJSON *old, const hn_verdict *v) {
    const bool graded = strcmp(text_of(old, "status"), "graded") == 0;
    const double score = hn_part_number(old, "score", (double)NAN);
    const double most = hn_part_number(old, "max_score", v->max_score);
    const double rounding = 1e-9 * fmax(1, v->max_score);
    return graded == (v->kind == HN_VERDICT_GRADED) &&
           (!graded ||
            (fabs(score - v->score) <= rounding && fabs(most - v->max_score) <= rounding));
}

/// Another score is an outcome that a script must see: HN_EXIT_ENDED.
static hn_exit compare(const hn_args *args, const cJSON *old, const hn_verdict *v) {
    const bool same = is_same(old, v);
    const hn_exit outcome = same ? HN_EXIT_DONE : HN_EXIT_ENDED;

    // as a document, or as text with the changes
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->json) {
        hn_json_object(&b);
        hn_json_put_string(&b, "problem", v->problem->id);
        hn_json_put_bool(&b, "same", same);
        hn_json_put_number(&b, "score_before", hn_part_number(old, "score", (double)NAN));
        hn_json_put_number(&b, "max_score_before", hn_part_number(old, "max_score", (double)NAN));
        hn_json_put_number(&b, "score", v->kind == HN_VERDICT_GRADED ? v->score : (double)NAN);
        hn_json_put_number(&b, "max_score", v->max_score);
        put_changes(&b, old, v, true);
        hn_json_end_object(&b);
        const hn_exit printed = hn_cli_print(&b);
        return printed == HN_EXIT_DONE ? outcome : printed;
    }
    put_scores(&b, old, v, same);
    put_changes(&b, old, v, false);
    hn_verdict_text(&b, v);
    const hn_exit printed = hn_cli_print_text(&b);
    return printed == HN_EXIT_DONE ? outcome : printed;
}

/// The exercise of the verdict: the file that was named to grade it, or the one of this id.
static hn_status load_exercise(const hn_library *lib, const cJSON *old, hn_exercise **out,
                               hn_diags *diags) {
    const char *id = text_of(old, "problem"), *file = text_of(old, "problem_file");
    if (!file[0] && !hn_library_problem_path(lib, id) && hn_library_scene_path(lib, id)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/problem", "holonom grade SCENE PROGRAM",
                            "'%.60s' is a scene, and this verdict does not hold the program that "
                            "was graded; grade it again",
                            id);
    }
    if (file[0] && access(file, F_OK) != 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/problem_file",
                            "put the file there, or call regrade where grade was called",
                            "the exercise '%.60s' was read from '%.200s', and no such file is "
                            "here",
                            id, file);
    }
    return hn_cli_load_exercise(lib, file[0] ? file : id, out, diags);
}

static bool has_options(const hn_exercise *e) {
    bool found = false;
    for (int i = 0; i < e->n_parts; i++) {
        found |= cJSON_GetObjectItemCaseSensitive(e->parts[i].node, "options") != NULL;
    }
    return found;
}

/// Has the options of the exercise dealt as they were for the verdict.
static hn_status take_letters(const cJSON *old, hn_exercise *e, hn_diags *diags) {
    const double letters = hn_part_number(old, "letters", 1);
    if (letters != 1 && letters != HN_LETTERS) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/letters", "grade it again with a newer holonom",
                            "the verdict has options in the order %g; this program knows 1 and %d",
                            letters, HN_LETTERS);
    }
    e->first_letters = letters == 1 && has_options(e);
    return HN_OK;
}

/// Reads the parameters of the scene that the verdict names into the words of --set.
static void take_settings(const cJSON *old, hn_words *out) {
    const cJSON *one;
    out->n = 0;
    cJSON_ArrayForEach(one, cJSON_GetObjectItemCaseSensitive(old, "set")) {
        if (cJSON_IsString(one) && out->n < (int)(sizeof out->word / sizeof *out->word)) {
            out->word[out->n++] = one->valuestring;
        }
    }
}

/// Compares the new verdict with the old one, or reports why there is no new one.
static hn_exit end_again(const hn_args *args, const cJSON *old, hn_verdict *v, hn_status status,
                         const hn_diags *diags) {
    if (status != HN_OK) {
        return hn_report_diags(args, status, diags);
    }
    snprintf(v->student, sizeof v->student, "%s", text_of(old, "student"));
    const hn_exit result = compare(args, old, v);
    return result != HN_EXIT_PROGRAM && v->kind == HN_VERDICT_UNGRADABLE ? HN_EXIT_INPUT : result;
}

/// The program of a scene: the file named, or the text that the verdict holds.
static hn_exit grade_program_again(const hn_library *lib, const hn_args *args, const cJSON *old,
                                   hn_verdict *v) {
    const char *id = text_of(old, "problem"), *text = text_of(old, "submission");
    hn_model *model = NULL;
    hn_filled_exam exam = {0};
    hn_diags diags = {0};
    hn_args with = *args;
    take_settings(old, &with.set);

    // graded as it was, with the parameters of then
    hn_status status = hn_args_load_model(lib, &with, id, 0, &model, &diags);
    HN_THEN(status, hn_filled_exam_init(&exam, model, &diags));
    if (status == HN_OK && args->words.n > 1) {
        status = hn_filled_program_grade(&exam, args->words.word[1], NULL, v);
    } else if (status == HN_OK && text[0]) {
        status = hn_filled_program_grade_text(&exam, text_of(old, "submission_file"), text,
                                              strlen(text), v);
    } else if (status == HN_OK) {
        status = hn_diags_add(&diags, HN_ERR_INPUT, "/submission", "name its file as second word",
                              "the verdict does not hold the program");
    }
    const hn_exit result = end_again(args, old, v, status, &diags);
    hn_filled_exam_reset(&exam);
    hn_model_free(model);
    return result;
}

static hn_exit grade_again(const hn_library *lib, const hn_args *args, const cJSON *old,
                           hn_verdict *v) {
    if (text_of(old, "submission_file")[0]) {
        return grade_program_again(lib, args, old, v);
    }
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    const char *submission = text_of(old, "submission");
    const uint64_t seed = strtoull(text_of(old, "seed"), NULL, 10);

    // the submission: the file named, or the copy that the verdict holds
    hn_status status = load_exercise(lib, old, &e, &diags);
    HN_THEN(status, take_letters(old, e, &diags));
    if (status == HN_OK && hn_cli_apply_rubric(args, e, &diags) != HN_OK) {
        hn_report_diags(args, diags.item[0].status, &diags);
        hn_exercise_free(e);
        return HN_EXIT_PROGRAM; // no fault of the submission
    }
    if (status == HN_OK && args->words.n > 1) {
        status = hn_grade_file(e, args->words.word[1], seed, v);
    } else if (status == HN_OK && submission[0]) {
        status = hn_grade_json(e, submission, strlen(submission), seed, v);
    } else if (status == HN_OK) {
        status = hn_diags_add(&diags, HN_ERR_INPUT, "/submission", "name its file as second word",
                              "the verdict does not hold the submission");
    }

    const hn_exit result = end_again(args, old, v, status, &diags);
    hn_exercise_free(e);
    return result;
}

hn_exit hn_command_regrade(const hn_library *lib, const hn_args *args) {
    hn_diags diags = {0};
    cJSON *old = load_verdict(args->words.word[0], &diags);
    if (!old) {
        return hn_report_diags(args, diags.n ? diags.item[0].status : HN_ERR_INPUT, &diags);
    }
    hn_verdict *v = calloc(1, sizeof *v);
    const hn_exit result = v ? grade_again(lib, args, old, v) : HN_EXIT_PROGRAM;
    free(v);
    cJSON_Delete(old);
    return result;
}
