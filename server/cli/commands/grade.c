// SPDX-License-Identifier: GPL-3.0-or-later
// holonom problem and holonom grade. Exit statuses: 0 graded, however low; 2 a submission that
// cannot be read, or a word that is wrong; 3 an exercise that does not load, an output that cannot
// be written.
#include "grade/grade.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/visible.h"
#include "class/filled_origin.h"
#include "cli/commands/exercise_word.h"
#include "cli/commands/grade_folder.h"
#include "cli/commands/rubric_file.h"
#include "cli/commands/verdict_names.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "grade/exercise_shelf.h"
#include "grade/submission.h"
#include "grade/variant.h"
#include "grade/verdict_forms.h"
#include "terminal/bars.h"
#include "terminal/width.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/// A bar for every entry, and one for the score.
static void write_bars(hn_strbuf *b, const hn_verdict *v) {
    static hn_bar bars[HN_GRADE_MAX_ENTRIES + 1];
    for (int i = 0; i <= v->n_entries; i++) {
        const hn_entry_verdict *e = i < v->n_entries ? &v->entry[i] : NULL;
        const double points = e ? e->points : v->score, most = e ? e->max_points : v->max_score;
        snprintf(bars[i].label, sizeof bars[i].label, "%s", e ? e->name : "score");
        snprintf(bars[i].value, sizeof bars[i].value, "%g of %g%s%s", points, most,
                 e && e->mistake[0] ? "  " : "", e ? e->mistake : "");
        bars[i].share = most > 0 ? points / most : (double)NAN;
        bars[i].colour = e && !e->right ? HN_CELL_ALARM : HN_CELL_INK;
    }
    hn_strbuf_printf(b, "%s: %s\n", v->problem->id, v->summary);
    hn_bars_text(b, bars, v->n_entries + 1, hn_terminal_columns(), hn_terminal_colours());
}

/// One submission, graded: what all of them share, and where its verdict goes.
typedef struct task {
    const hn_library *lib;
    const hn_args *args;
    hn_grade_subject subject;
    const hn_verdict_form *form;
    const char *submission;
    const char *target; ///< path without ending; NULL: standard output
} task;

/// The picture of the state at which a wrong entry shows; empty where there is none to draw.
static hn_exit draw_picture(const task *t, const hn_verdict *v, hn_strbuf *png) {
    hn_diags diags = {0};
    if (t->args->no_pictures || !(t->target || t->form->pictures)) {
        return HN_EXIT_DONE;
    }
    const hn_status status = hn_shelf_verdict_png(png, t->lib, v, &diags);
    if (status != HN_OK && (status != HN_ERR_UNSUPPORTED || diags.n > 0)) {
        hn_report_diags(t->args, status, &diags);
        return HN_EXIT_PROGRAM;
    }
    return HN_EXIT_DONE;
}

/// The verdict into a file, and the picture beside it unless a person reads it in the verdict; one
/// line on standard output.
static hn_exit write_files(const task *t, const hn_verdict *v, hn_strbuf *b, hn_strbuf *png) {
    hn_strbuf path;
    hn_strbuf_init(&path);
    hn_strbuf_printf(&path, "%s.%s", t->target, t->form->ending);
    const bool inside = t->form->pictures && !t->form->results;
    const bool drawn = png->n > 0 && !inside;
    hn_exit result = hn_cli_write_file(t->args, hn_strbuf_text(&path), b);
    if (result == HN_EXIT_DONE && drawn) {
        hn_strbuf_clear(&path);
        hn_strbuf_printf(&path, "%s.png", t->target);
        result = hn_cli_write_file(t->args, hn_strbuf_text(&path), png);
    }
    hn_strbuf_reset(&path);
    hn_strbuf line;
    hn_strbuf_init(&line);
    hn_visible_add(&line, t->submission, true);
    hn_strbuf_add(&line, ": ");
    hn_visible_add(&line, v->kind == HN_VERDICT_UNGRADABLE ? v->reason : v->summary, true);
    puts(hn_strbuf_text(&line));
    hn_strbuf_reset(&line);
    return result;
}

/// The verdict, and under --out the picture and a line on standard output.
static hn_exit write_result(const task *t, const hn_verdict *v, double seconds) {
    hn_strbuf b, png;
    hn_strbuf_init(&b);
    hn_strbuf_init(&png);
    const hn_exit drawn = draw_picture(t, v, &png);
    const bool text = strcmp(t->form->name, "text") == 0, several = t->args->words.n > 2;

    // under the name of its submission where there are several
    if (several && text && !t->target) {
        hn_strbuf_printf(&b, "== %s\n", t->submission);
    }
    const hn_verdict_extra extra = {.seconds = seconds,
                                    .first = t->target || t->submission == t->args->words.word[1],
                                    .submission = several && !t->target ? t->submission : NULL,
                                    .png = png.n > 0 ? &png : NULL};
    hn_strbuf_add(&b, t->target ? t->form->head : "");
    if (t->args->plot && text && v->kind == HN_VERDICT_GRADED) {
        write_bars(&b, v);
    } else {
        t->form->write(&b, v, &extra);
    }
    hn_strbuf_add(&b, t->target ? t->form->tail : "");

    // a picture that cannot be drawn takes no verdict away
    const hn_exit written = t->target ? write_files(t, v, &b, &png)
                            : text    ? hn_cli_print_text(&b)
                                      : hn_cli_print(&b);
    hn_strbuf_reset(&png);
    return written != HN_EXIT_DONE ? written : drawn;
}

/// Returns whether a file begins as zip files do.
static bool is_zip(const char *path) {
    char begin[4];
    return hn_file_begin(path, begin, sizeof begin) == sizeof begin &&
           memcmp(begin, "PK\003\004", sizeof begin) == 0;
}

/// The verdict of a submission that nobody can grade: an exercise or a rubric is at fault.
static hn_exit write_failure(const task *t, const hn_exercise *exercise, const hn_diag *why) {
    hn_verdict *v = calloc(1, sizeof *v);
    if (!v) {
        return HN_EXIT_PROGRAM;
    }
    hn_submission_refuse(v, "tell your teacher; your file was not read",
                         "the exercise or its rubric is at fault, not the submission (%.300s)",
                         why->message);
    v->no_submission = true;
    v->problem = exercise;
    v->shown_entry = -1;
    snprintf(v->student, sizeof v->student, "%s", t->args->student ? t->args->student : "");
    write_result(t, v, 0);
    free(v);
    return HN_EXIT_PROGRAM;
}

/// Says which variant --seed chose for a wrong answer whose file names none.
static void remark_variant(const task *t, hn_verdict *v) {
    if (v->unnamed && !t->args->student && t->subject.exercise->n_parts > 0 &&
        v->kind == HN_VERDICT_GRADED && v->n_right < v->n_entries) {
        hn_submission_remark(v,
                             "the file names no variant: graded as that of seed %llu, as the "
                             "command line says",
                             (unsigned long long)v->seed);
    }
}

static hn_exit grade_one(const task *t) {
    const double start = hn_clock_wall();
    hn_verdict *v = calloc(1, sizeof *v);
    hn_graded_program program = {.set = t->args->set.word, .n_set = t->args->set.n};
    hn_strbuf_init(&program.text);

    // the variant of this student, or of the seed given, or what the file says
    const uint64_t seed = hn_cli_variant_seed(t->args, t->subject.exercise);
    hn_status status =
        !v ? HN_ERR_MEMORY
        : t->subject.programs
            ? hn_filled_program_grade(t->subject.programs, t->submission, &program, v)
            : hn_grade_file(t->subject.exercise, t->submission, seed, v);

    if (status == HN_OK && v->kind == HN_VERDICT_UNGRADABLE && is_zip(t->submission)) {
        hn_submission_refuse(v,
                             "unpack it: unzip FILE.zip -d FOLDER; a FOLDER is graded as a class, "
                             "and may hold a zip file for each student",
                             "it is a zip file");
    }

    // a submission that cannot be graded is the fault of the input
    hn_exit result = HN_EXIT_PROGRAM;
    if (status == HN_OK) {
        if (t->args->student) {
            if (!t->subject.programs && t->subject.exercise->n_parts == 0) {
                hn_submission_check_student(v, t->args->student);
            }
            snprintf(v->student, sizeof v->student, "%s", t->args->student);
        }
        remark_variant(t, v);
        v->show_expected = t->args->show_expected;
        result = write_result(t, v, hn_clock_wall() - start);
        result =
            result == HN_EXIT_DONE && v->kind == HN_VERDICT_UNGRADABLE ? HN_EXIT_INPUT : result;
    } else {
        hn_diag diag;
        hn_diag_set(&diag, status, NULL, NULL, "the grader failed on '%.200s': %s", t->submission,
                    v && v->reason[0] ? v->reason : hn_status_text(status));
        hn_report_diag(t->args, &diag);

        // a platform gets a result that names the exercise's fault
        if (v && v->reason[0] && (t->args->out || t->args->format)) {
            hn_diag_set(&diag, status, NULL, NULL, "%s", v->reason);
            write_failure(t, t->subject.exercise, &diag);
        }
    }
    hn_strbuf_reset(&program.text);
    free(v);
    return result;
}

/// One bad submission never stops the rest; the worst outcome is the exit status.
static hn_exit grade_all(task t, const hn_verdict_names *names) {
    hn_exit worst = HN_EXIT_DONE;
    fputs(t.args->out ? "" : t.form->head, stdout);
    for (int i = 1; i < t.args->words.n; i++) {
        t.submission = t.args->words.word[i];
        t.target = t.args->out ? names->path[i - 1] : NULL;
        const hn_exit one = grade_one(&t);
        worst = one > worst ? one : worst;
    }
    hn_strbuf tail;
    hn_strbuf_init(&tail);
    hn_strbuf_add(&tail, t.args->out ? "" : t.form->tail);
    const hn_exit ended = hn_cli_print(&tail);
    return ended > worst ? ended : worst;
}

/// Subject that ID names, owned.
typedef struct owned_subject {
    bool is_scene; ///< ID is a scene, not an exercise
    hn_exercise *exercise;
    hn_variant_owner student; ///< of --student, whom the exercise points to
    hn_model *model;          ///< of a scene whose program is graded
    hn_filled_exam exam;
    hn_blank_programs blanks; ///< of a class of programs
} owned_subject;

/// Returns whether a submission is the program of a scene, by its ending and its first lines.
static bool is_program_of_a_scene(const char *path) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    const bool found = hn_filled_program_is(path) &&
                       hn_file_read(path, HN_GRADE_MAX_BYTES, &text, NULL) == HN_OK &&
                       hn_filled_origin_is_known(hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
    return found;
}

/// Kind of subject that ID states.
typedef enum id_kind { ID_ALONE, ID_SCENE, ID_EXERCISE } id_kind;

/// Takes "scene:" or "exercise:" off ID.
static id_kind take_kind(hn_args *args) {
    static const char *const prefixes[] = {[ID_SCENE] = "scene:", [ID_EXERCISE] = "exercise:"};
    for (int kind = ID_SCENE; kind <= ID_EXERCISE; kind++) {
        const size_t n = strlen(prefixes[kind]);
        if (strncmp(args->words.word[0], prefixes[kind], n) == 0) {
            args->words.word[0] += n;
            return (id_kind)kind;
        }
    }
    return ID_ALONE;
}

/// Returns whether ID is a scene: it says so, there is no exercise of this name, or there is one
/// too and the submissions are files with programs; a class goes to the exercise, with a note.
/// Fails:
/// HN_ERR_INPUT, some files are programs and some are not.
static hn_status choose_scene(const hn_library *lib, const hn_args *args, id_kind kind, bool class,
                              bool *is_scene, hn_diags *diags) {
    const char *id = args->words.word[0];
    *is_scene = kind == ID_SCENE;
    if (kind != ID_ALONE || !hn_library_scene_path(lib, id)) {
        return HN_OK;
    }
    if (!hn_library_problem_path(lib, id)) {
        *is_scene = true;
        return HN_OK;
    }
    if (class) {
        hn_cli_note("holonom: '%.40s' is an exercise and a scene; graded as the exercise, with "
                    "scene:%.40s as the program of the scene\n",
                    id, id);
        return HN_OK;
    }

    // an exercise and a scene have this name
    const char *program = NULL, *other = NULL;
    for (int i = 1; i < args->words.n; i++) {
        const char **one = is_program_of_a_scene(args->words.word[i]) ? &program : &other;
        *one = args->words.word[i];
    }
    if (program && other) {
        char hint[HN_DIAG_HINT];
        snprintf(hint, sizeof hint,
                 "grade answers (exercise:%.40s) and programs (scene:%.40s) apart", id, id);
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, hint,
                            "'%.40s' is an exercise and a scene; '%.200s' is the program of a "
                            "scene and '%.200s' is not",
                            id, program, other);
    }
    *is_scene = program != NULL;
    return HN_OK;
}

/// Finds an exercise, or the scene whose program was filled in.
static hn_status find_subject(const hn_library *lib, const hn_args *args, owned_subject *own,
                              hn_grade_subject *out, hn_diags *diags) {
    const char *id = args->words.word[0];
    hn_status status;
    if (!own->is_scene) {
        status = hn_cli_load_exercise(lib, id, &own->exercise, diags);
        if (status == HN_OK && args->student) {
            own->student = (hn_variant_owner){
                .name = args->student, .seed = hn_variant_seed(own->exercise, args->student)};
            own->exercise->owners = &own->student;
            own->exercise->n_owners = 1;
        }
        *out = (hn_grade_subject){.exercise = own->exercise};
        return status;
    }
    status = hn_args_load_model(lib, args, id, 0, &own->model, diags);
    HN_THEN(status, hn_filled_exam_init(&own->exam, own->model, diags));
    *out = (hn_grade_subject){.exercise = &own->exam.exercise, .programs = &own->exam};
    return status;
}

/// Applies --rubric to an exercise of formulas; the parts of a program have the points they have.
static hn_status apply_rubric(const hn_args *args, owned_subject *own, hn_diags *diags) {
    if (own->exercise) {
        return hn_cli_apply_rubric(args, own->exercise, diags);
    }
    return args->rubric ? hn_diags_add(diags, HN_ERR_INPUT, "/rubric", "leave --rubric out",
                                       "the program of a scene has no rubric")
                        : HN_OK;
}

static void free_subject(owned_subject *own) {
    hn_exercise_free(own->exercise);
    hn_filled_exam_reset(&own->exam);
    hn_blank_programs_reset(&own->blanks);
    hn_model_free(own->model);
}

/// The ending of a file's name that is that of no form of verdicts, with its dot: letters alone,
/// for a folder may be called v1.2. NULL: there is none, or a slash behind it names a folder.
static const char *find_strange_ending(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    const size_t n = dot && dot > name ? strlen(dot + 1) : 0;
    return n > 0 && strspn(dot + 1, "abcdefghijklmnopqrstuvwxyz") == n ? dot : NULL;
}

/// The form that --format or --json names; else that of the ending of --out; else text. An --out
/// that is the name of a file must be one of this form, and for one submission.
static hn_status choose_form(const hn_args *args, const hn_verdict_form **out, hn_diag *diag) {
    struct stat info;
    const bool folder = args->out && stat(args->out, &info) == 0 && S_ISDIR(info.st_mode);
    const hn_verdict_form *file = args->out && !folder ? hn_verdict_form_of_file(args->out) : NULL;
    const char *said = args->format ? args->format : args->json ? "json" : NULL;
    HN_TRY(hn_verdict_form_find(said ? said : file ? file->name : "text", out, diag));
    if (args->out && !folder && !file && stat(args->out, &info) == 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/out", "--out DIR, or --out FILE.txt",
                           "'%.200s' is no folder, and its ending is that of no form of verdicts",
                           args->out);
    }
    const char *strange = args->out && !folder && !file ? find_strange_ending(args->out) : NULL;
    if (strange) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/out",
                           "a folder for the verdicts has a slash at its end",
                           "'%.200s' ends in %.20s; the form %s has files that end in .%s",
                           args->out, strange, (*out)->name, (*out)->ending);
    }
    if (file && strcmp(file->ending, (*out)->ending) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/out",
                           "choose another ending, or leave --format out",
                           "'%.200s' ends in .%s; the form %s has files that end in .%s", args->out,
                           file->ending, (*out)->name, (*out)->ending);
    }
    if (file && args->words.n > 2) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/out", "--out DIR, with a slash at its end",
                           "'%.200s' is the name of one file, and %d submissions are graded",
                           args->out, args->words.n - 1);
    }
    return HN_OK;
}

/// Submissions that are files, each with a verdict of its own.
static hn_exit grade_files(task t) {
    const hn_args *args = t.args;
    hn_verdict_names names = {0};
    hn_diags diags = {0};
    hn_diag diag = {0};
    if (choose_form(args, &t.form, &diag) != HN_OK) {
        return hn_report_diag(args, &diag);
    }

    // every name is chosen, and every folder made, before the first verdict is written
    hn_status status = HN_OK;
    if (args->out) {
        status = hn_verdict_names_choose(&names, args->out, args->words.word + 1, args->words.n - 1,
                                         t.form->ending, t.form->results, &diags);
    }
    const hn_exit result =
        status == HN_OK ? grade_all(t, &names) : hn_report_diags(args, status, &diags);
    hn_verdict_names_reset(&names);
    return result;
}

/// Reports a fault of the teacher. If a file or the form of a platform was asked for, each
/// submission gets it as its verdict, so that no platform takes the fault for a missing result.
static hn_exit fail_all(task t, const owned_subject *own, hn_status status, const hn_diags *diags) {
    const hn_args *args = t.args;
    const hn_exercise unknown = {.id = args->words.word[0], .title = args->words.word[0]};
    const hn_exercise *exercise = own->exercise ? own->exercise : &unknown;
    hn_verdict_names names = {0};
    hn_diags more = {0};
    hn_diag diag = {0};
    hn_report_diags(args, status, diags);
    if ((!args->out && !args->format) || choose_form(args, &t.form, &diag) != HN_OK) {
        return HN_EXIT_PROGRAM;
    }
    if (args->out &&
        hn_verdict_names_choose(&names, args->out, args->words.word + 1, args->words.n - 1,
                                t.form->ending, t.form->results, &more) != HN_OK) {
        hn_report_diags(args, more.item[0].status, &more);
        return HN_EXIT_PROGRAM;
    }
    for (int i = 1; i < args->words.n; i++) {
        t.submission = args->words.word[i];
        t.target = args->out ? names.path[i - 1] : NULL;
        write_failure(&t, exercise, &diags->item[0]);
    }
    hn_verdict_names_reset(&names);
    return HN_EXIT_PROGRAM;
}

/// Refuses options that would say nothing here, and two that say different things.
static hn_status check_options(const hn_args *args, bool class, bool programs, hn_diags *diags) {
    const bool text = !args->json && (!args->format || strcmp(args->format, "text") == 0);
    const struct {
        bool given;
        const char *pointer, *says, *hint;
    } rows[] = {
        {args->json && args->format && strcmp(args->format, "json") != 0, "/format",
         "--json and --format choose different forms", "--json is --format json"},
        {args->plot && !text, "/plot", "--plot draws bars in the place of text alone",
         "leave --plot out, or the form"},
        {class && args->plot, "/plot", "--plot is for one submission, not for a class",
         "leave --plot out"},
        {class && args->show_expected, "/show_expected",
         "--show-expected is for one submission, not for a class", "leave --show-expected out"},
        {args->shard && args->merge, "/merge",
         "--shard grades a part of a class, --merge puts graded parts together",
         "leave one of them out"},
        {!programs && args->set.n > 0, "/set",
         "--set is for the program of a scene; an exercise has the numbers of its variant",
         "leave --set out, or choose the variant with --seed or --student"},
        {programs && !isnan(args->seed), "/seed",
         "--seed chooses a variant, and the program of a scene has none",
         "leave --seed out; --set NAME=VALUE changes the scene"},
        {!class && !isnan(args->jobs), "/jobs", "--jobs is for a folder of submissions",
         "leave --jobs out, or name the folder"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].given) {
            return hn_diags_add(diags, HN_ERR_INPUT, rows[i].pointer, rows[i].hint, "%s",
                                rows[i].says);
        }
    }
    return hn_cli_check_student(args, diags);
}

hn_exit hn_command_grade(const hn_library *lib, const hn_args *typed) {
    hn_args without_kind = *typed;
    const id_kind kind = take_kind(&without_kind);
    const hn_args *args = &without_kind;
    task t = {.lib = lib, .args = args};
    owned_subject own = {0};
    hn_diags diags = {0};
    struct stat info;
    hn_exit result;
    const bool folder = stat(args->words.word[1], &info) == 0 && S_ISDIR(info.st_mode);
    const bool class = folder || args->shard || args->merge;
    hn_status status = choose_scene(lib, args, kind, class, &own.is_scene, &diags);
    const bool chosen = status == HN_OK;
    HN_THEN(status, find_subject(lib, args, &own, &t.subject, &diags));
    bool failed = chosen && status != HN_OK;
    HN_THEN(status, check_options(args, class, t.subject.programs, &diags));
    if (status == HN_OK) {
        status = apply_rubric(args, &own, &diags);
        failed = status != HN_OK;
    }
    if (status == HN_OK && folder && own.model) {
        status = hn_blank_programs_init(&own.blanks, own.model, lib);
        t.subject.blanks = &own.blanks;
    }
    if (failed && !class) {
        result = fail_all(t, &own, status, &diags);
    } else if (status != HN_OK) {
        result = hn_report_diags(args, status, &diags);
        result = failed ? HN_EXIT_PROGRAM : result;
    } else if (args->merge) {
        result = hn_grade_merge(args, &t.subject);
    } else if (folder || args->shard) {
        result = hn_grade_folder(args, &t.subject);
    } else {
        result = grade_files(t);
    }
    free_subject(&own);
    return result;
}
