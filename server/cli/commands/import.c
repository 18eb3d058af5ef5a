// SPDX-License-Identifier: GPL-3.0-or-later
// holonom import: a mechanism written for another program, as a scene; what of it is not in the
// scene is told.
#include "import/import.h"
#include "base/file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "session/model/model.h"
#include "session/model/model_json.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Reads a file, or standard input where `path` is "-".
static hn_status read_file(const char *path, hn_strbuf *text, hn_diags *diags) {
    return strcmp(path, "-") == 0 ? hn_file_read_stdin(HN_IMPORT_MAX_BYTES, text, diags)
                                  : hn_file_load(path, HN_IMPORT_MAX_BYTES, text, diags);
}

/// A file below the folder `user` (as realpath tells it): a link that leads out of it is not
/// followed.
static hn_status read_included(void *user, const char *name, size_t most, hn_strbuf *text,
                               hn_diag *diag) {
    const char *folder = user;
    const size_t n = strlen(folder);
    hn_strbuf path;
    hn_strbuf_init(&path);
    hn_strbuf_printf(&path, "%s/%s", folder, name);
    char *real = path.failed ? NULL : realpath(hn_strbuf_text(&path), NULL);
    const int why = errno;
    hn_status status = path.failed ? HN_ERR_MEMORY : HN_OK;
    const int below = real && strncmp(real, folder, n) == 0 && (real[n] == '/' || n == 1);

    // a link that leads out of the folder is not followed
    if (status == HN_OK && !real) {
        status = hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot read '%.100s': %s", name,
                             strerror(why));
    } else if (status == HN_OK && !below) {
        status = hn_diag_set(diag, HN_ERR_IO, NULL, "copy it beside the model",
                             "'%.100s' is a link that leads out of the model's folder; only files "
                             "in this folder are read",
                             name);
    } else if (status == HN_OK) {
        status = hn_file_read(real, most, text, diag);
    }
    free(real);
    hn_strbuf_reset(&path);
    return status;
}

/// The folder of a file, as realpath tells it; owned. NULL: standard input, or it cannot be told.
static char *folder_of(const char *path) {
    char *real = strcmp(path, "-") == 0 ? NULL : realpath(path, NULL);
    char *slash = real ? strrchr(real, '/') : NULL;
    if (slash) {
        slash[slash == real] = '\0';
    }
    return real;
}

static hn_status read_source(const hn_args *args, hn_import **out, hn_diags *diags) {
    const char *path = args->words.word[0], *slash = strrchr(path, '/');
    hn_strbuf text, loops;
    hn_strbuf_init(&text);
    hn_strbuf_init(&loops);
    hn_status status = read_file(path, &text, diags);
    if (status == HN_OK && args->loops) {
        status = read_file(args->loops, &loops, diags);
    }

    // files that the model includes are looked for beside it
    if (status == HN_OK) {
        char *folder = folder_of(path);
        hn_import_source source = {.text = hn_strbuf_text(&text),
                                   .n = text.n,
                                   .loops = args->loops ? hn_strbuf_text(&loops) : NULL,
                                   .n_loops = loops.n,
                                   .key = args->key,
                                   .file = folder ? (slash ? slash + 1 : path) : NULL,
                                   .read = folder ? read_included : NULL,
                                   .user = folder};
        status = hn_import_read(&source, out, diags);
        hn_diags_name_file(diags, 0, folder ? path : "standard input");
        free(folder);
    }
    hn_strbuf_reset(&text);
    hn_strbuf_reset(&loops);
    return status;
}

/// Finds the configuration of the scene with its loops closed; reported, not demanded: what
/// assembly misses is a fact about the model.
static hn_status assemble(const hn_library *lib, const hn_import *im, hn_model **out,
                          hn_diags *diags) {
    hn_model_source source = {.allow_open = 1};
    source.text = hn_import_scene(im, &source.n_text);
    return hn_model_load(lib, &source, out, diags);
}

static void put_assembly(hn_strbuf *b, const hn_model *model, const hn_diags *why) {
    hn_json_key(b, "assembly");
    hn_json_object(b);
    if (!model) {
        hn_json_put_bool(b, "ok", 0);
        hn_json_put_string(b, "reason", why->item[0].message);
        hn_json_end_object(b);
        return;
    }
    const hn_assembly *a = hn_model_assembly(model);
    hn_model_closed_put(b, model);
    hn_json_put_number(b, "gap", a->gap);
    hn_json_put_number(b, "moved", a->moved);
    hn_json_put_int(b, "rank", a->rank);
    hn_json_put_int(b, "redundant", a->redundant);
    hn_json_put_int(b, "vanished", hn_system_get_info(hn_model_system(model)).rows_dropped);
    hn_json_put_int(b, "dof", a->freedoms);
    hn_json_end_object(b);
}

static void put_counts(hn_strbuf *b, const hn_import *im) {
    hn_import_info info = hn_import_get_info(im);
    hn_json_put_int(b, "bodies", info.n_bodies);
    hn_json_put_int(b, "carriers", info.n_carriers);
    hn_json_put_int(b, "joints", info.n_joints);
    hn_json_put_int(b, "closing", info.n_closing);
    hn_json_put_int(b, "constraints", info.n_constraints);
    hn_json_put_int(b, "loads", info.n_loads);
    hn_json_put_int(b, "parameters", info.n_params);
    hn_json_put_number(b, "mass", info.mass);
    hn_json_put_numbers(b, "com", info.com, 3);
}

/// With --json: everything in one object; the scene itself unless it went into a file.
static hn_exit print_json(const hn_args *args, const hn_import *im, const hn_model *model,
                          const hn_diags *why) {
    hn_strbuf b;
    size_t n;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "format", hn_import_format(im));
    put_counts(&b, im);
    put_assembly(&b, model, why);
    hn_import_put_notes(&b, im);
    if (args->out) {
        hn_json_put_string(&b, "written", args->out);
    } else {
        hn_json_key(&b, "scene");
        hn_json_raw(&b, hn_import_scene(im, &n));
    }
    hn_json_end_object(&b);
    return hn_cli_print(&b);
}

static void tell_notes(const hn_import *im) {
    for (int i = 0; i < hn_import_note_count(im); i++) {
        const hn_import_note *note = hn_import_note_at(im, i);
        hn_cli_note("%s%sline %d: %s: %s (%s)\n", note->file ? note->file : "",
                    note->file ? ", " : "", note->line, hn_import_outcome_name(note->outcome),
                    note->what, note->where);
    }
}

static void tell_assembly(const hn_model *model, const hn_diags *why) {
    if (!model) {
        hn_cli_note("holonom: the scene was written, but not compiled: %s\n", why->item[0].message);
        return;
    }
    const hn_assembly *a = hn_model_assembly(model);
    const hn_diag *open = hn_model_why_open(model);
    if (open) {
        hn_cli_note("holonom: the scene was written, but cannot be assembled: %s\n         %s\n",
                    open->message, open->hint);
        return;
    }
    hn_cli_note("holonom: assembled with a gap of %.2g m and %d degree%s of freedom; closure "
                "equations that depend on others: %d; that hold in every configuration: %d\n",
                a->gap, a->freedoms, a->freedoms == 1 ? "" : "s", a->redundant,
                hn_system_get_info(hn_model_system(model)).rows_dropped);
}

static void tell_summary(const hn_import *im) {
    hn_import_info info = hn_import_get_info(im);
    hn_cli_note("holonom: %s with %d bodies%s, %d joints, %d of its joints and constraints closing "
                "loops; %.6g kg\n",
                hn_import_format(im), info.n_bodies - info.n_carriers,
                info.n_carriers
                    ? " (and auxiliary bodies without mass, between several joints of one body)"
                    : "",
                info.n_joints, info.n_closing, info.mass);
    hn_cli_note("holonom: not in the scene: %d ignored, %d approximated, %d refused\n",
                hn_import_count(im, HN_IMPORT_IGNORED), hn_import_count(im, HN_IMPORT_APPROXIMATED),
                hn_import_count(im, HN_IMPORT_REFUSED));
}

static hn_exit write_scene(const hn_args *args, const hn_import *im) {
    hn_strbuf b;
    size_t n;
    hn_strbuf_init(&b);
    const char *text = hn_import_scene(im, &n);
    hn_strbuf_add_n(&b, text, n);
    return hn_cli_write_file(args, args->out, &b);
}

hn_exit hn_command_import(const hn_library *lib, const hn_args *args) {
    hn_import *im = NULL;
    hn_model *model = NULL;
    hn_diags diags = {0}, why = {0};
    hn_status status = read_source(args, &im, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    status = assemble(lib, im, &model, &why);
    if (status == HN_ERR_MEMORY) {
        hn_import_free(im);
        return hn_report_diags(args, status, &why);
    }

    // the scene first, so that what is said of it is true
    hn_exit result = args->out || !args->json ? write_scene(args, im) : HN_EXIT_DONE;
    if (result == HN_EXIT_DONE && args->json) {
        result = print_json(args, im, model, &why);
    } else if (result == HN_EXIT_DONE) {
        tell_notes(im);
        tell_summary(im);
        tell_assembly(model, &why);
    }
    hn_model_free(model);
    hn_import_free(im);
    return result;
}
