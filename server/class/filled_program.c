// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // mkdtemp
#include "class/filled_program.h"

#include "base/file.h"
#include "base/hash.h"
#include "class/filled_origin.h"
#include "class/filled_parts.h"
#include "export/language.h"
#include "grade/submission.h"
#include "program/guest_process.h"
#include "program/sandbox.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

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
        f->exercise.n_parts += hn_filled_part_is_asked(&f->exam, (hn_export_part)part);
    }
    f->exercise.points = HN_FILLED_POINTS * f->exercise.n_parts;
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

// ---- asking ----

/// Sends one state and reads the numbers of its answer.
static hn_status ask(const hn_export_exam *exam, hn_guest_process *process, int k, double seconds,
                     hn_filled_answers *out, hn_diag *diag) {
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

static hn_status ask_all(const hn_export_exam *exam, const char *path, hn_filled_answers *out,
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

// ---- the whole ----

/// Runs the program and compares its answers part by part. *answered = false: `diag` says why not.
static hn_status compare_answers(const hn_filled_exam *f, const char *path,
                                 const hn_language *language, hn_verdict *v, bool *answered,
                                 hn_diag *diag) {
    hn_filled_answers given = {0};
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        given.n += f->exam.size[part];
    }
    given.value = calloc((size_t)given.n * HN_EXPORT_EXAM_STATES, sizeof *given.value);
    if (!given.value) {
        return HN_ERR_MEMORY;
    }

    *answered = ask_all(&f->exam, path, &given, diag) == HN_OK;
    const hn_status status = *answered ? hn_filled_parts_compare(f, language, &given, v) : HN_OK;
    free(given.value);
    return status;
}

static void keep_program(hn_graded_program *kept, const char *path, const hn_strbuf *text) {
    const char *slash = strrchr(path, '/');
    snprintf(kept->file, sizeof kept->file, "%.79s", slash ? slash + 1 : path);
    hn_strbuf_clear(&kept->text);
    hn_strbuf_add_n(&kept->text, hn_strbuf_text((hn_strbuf *)text), text->n);
}

hn_status hn_filled_program_grade_text(const hn_filled_exam *f, const char *name, const char *text,
                                       size_t n, hn_verdict *v) {
    const char *dot = hn_filled_program_is(name) ? strrchr(name, '.') : "";
    const char *parent = getenv("TMPDIR");
    char folder[1024], path[1100];
    snprintf(folder, sizeof folder, "%.900s/holonom-XXXXXX", parent ? parent : "/tmp");
    if (!mkdtemp(folder)) {
        return HN_ERR_IO;
    }
    // a compiler prints the name of the file: it is the same every time
    snprintf(path, sizeof path, "%s/program%.8s", folder, dot);
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    const bool written = fd >= 0 && write(fd, text, n) == (ssize_t)n;
    if (fd >= 0) {
        close(fd);
    }
    const hn_status status = written ? hn_filled_program_grade(f, path, NULL, v) : HN_ERR_IO;
    unlink(path);
    rmdir(folder);
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

    bool answered = false;
    if (status == HN_OK) {
        HN_TRY(compare_answers(f, path, language, v, &answered, &diag));
    }
    if (!answered) {
        hn_submission_refuse(v, diag.hint, "%s", diag.message);
    }

    // numbers of another scene or other parameters say nothing about what was filled in
    if (is_other && (!answered || v->n_right < v->n_entries)) {
        v->n_entries = v->n_right = 0;
        v->score = 0;
        v->summary[0] = '\0';
        hn_submission_refuse(v, origin.hint, "%s", origin.message);
    }
    return HN_OK;
}
