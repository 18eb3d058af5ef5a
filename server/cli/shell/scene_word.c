// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/scene_word.h"

#include "base/file.h"
#include "base/units.h"
#include "cli/shell/args.h"
#include "cli/shell/notes.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/system.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

hn_status hn_assignments_read(const hn_words *words, const char *option, hn_see_assignment see,
                              void *user, hn_diags *diags) {
    for (int i = 0; i < words->n; i++) {
        char copy[256], *rest = copy;
        int n = snprintf(copy, sizeof copy, "%s", words->word[i]);

        // several assignments may stand in one word
        for (char *part = strsep(&rest, ","); part; part = strsep(&rest, ",")) {
            char *equals = strchr(part, '=');
            double value;
            if (n >= (int)sizeof copy || !equals || equals == part ||
                !hn_number_parse(equals + 1, &value)) {
                return hn_diags_add(diags, HN_ERR_INPUT, NULL, "NAME=VALUE, as in l1=1.2",
                                    "%s takes a name and a finite number, not '%.80s'", option,
                                    words->word[i]);
            }
            *equals = 0;
            hn_status status = see(user, part, value);
            if (status != HN_OK) {
                return status;
            }
        }
    }
    return HN_OK;
}

/// A start that differs by less is the one that was asked for, to the digits of assembly.
#define START_SAME 1e-9

typedef struct settings {
    hn_diags *diags;
    bool overrides; ///< a value stands in place of one that is there
    int n;
    hn_setting item[HN_SCENE_MAX_PARAMS];
    char names[HN_SCENE_MAX_PARAMS][64];
} settings;

static hn_status see_setting(void *user, const char *name, double value) {
    settings *s = user;
    for (int i = 0; i < s->n; i++) {
        if (strcmp(s->names[i], name) == 0 && s->overrides) {
            s->item[i].value = value;
            return HN_OK;
        }
        if (strcmp(s->names[i], name) == 0) {
            return hn_diags_add(s->diags, HN_ERR_INPUT, NULL, NULL,
                                "--set gives '%.60s' twice, %g and %g; it takes one value", name,
                                s->item[i].value, value);
        }
    }
    if (s->n == HN_SCENE_MAX_PARAMS) {
        return HN_ERR_LIMIT;
    }
    snprintf(s->names[s->n], sizeof s->names[s->n], "%s", name);
    s->item[s->n] = (hn_setting){.name = s->names[s->n], .value = value};
    s->n++;
    return HN_OK;
}

static bool names_json(const char *word) {
    const size_t n = strlen(word);
    return n > 5 && strcmp(word + n - 5, ".json") == 0;
}

/// The fault of a word that ends in .json and names no file: the shipped scenes have no such
/// ending.
static hn_status report_no_file(const hn_library *lib, const char *word, hn_diags *diags) {
    char name[80], hint[HN_DIAG_HINT];
    snprintf(name, sizeof name, "%.*s", (int)(strlen(word) - 5), word);
    const char *near = hn_nearest_name(name, hn_library_scene_ids(lib), hn_library_n_scenes(lib));
    snprintf(hint, sizeof hint,
             near ? "the shipped scene is called '%s'"
                  : "name a file by its path; 'holonom list scenes' names the shipped scenes%s",
             near ? near : "");
    return hn_diags_add(diags, HN_ERR_INPUT, "/scene", hint, "there is no file '%.80s'", word);
}

/// Says which parameters lie outside the range of their sliders.
static void tell_beyond(const hn_model *model) {
    const hn_scene *scene = hn_model_scene(model);
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        if (p->beyond) {
            const int digits = hn_digits_apart(p->value, p->value < p->min ? p->min : p->max, 6);
            hn_cli_note("holonom: %s = %.*g is outside its range, %.*g to %.*g%s%s; the texts of "
                        "this scene hold inside the range only\n",
                        p->name, digits, p->value, digits, p->min, digits, p->max,
                        p->unit[0] ? " " : "", p->unit);
        }
    }
}

/// Says that a start value is not the one that was asked for. `param`: the scene holds it at this
/// parameter's value, or NULL.
static void tell_moved(const char *name, double asked, double found, const char *param) {
    if (fabs(found - asked) <= START_SAME * fmax(1, fabs(asked))) {
        return;
    }
    const int digits = hn_digits_apart(found, asked, 6);
    hn_cli_note("holonom: %s starts at %.*g, not at %.*g: assembly begins at the values that are "
                "set and changes them to close the loops%s%s%s\n",
                name, digits, found, digits, asked, param ? "; set " : "", param ? param : "",
                param ? " to hold it" : "");
}

/// Says which start values that were asked for the closed loops do not allow beside the others.
static void tell_start(const hn_model *model, const settings *s) {
    const hn_system *sys = hn_model_system(model);
    const int n = hn_system_get_info(sys).nv;
    double *q = calloc(2 * (size_t)n + 1, sizeof *q), *v = q ? q + n : NULL;
    if (!q) {
        return;
    }

    // the start as the scene's coordinates have it
    hn_system_to_user(sys, hn_model_q(model), q);
    hn_system_rates_to_user(sys, hn_model_v(model), v);
    for (int k = 0; k < n; k++) {
        const hn_coordinate *c =
            &hn_model_scene(model)->coordinates[hn_system_user_coordinate(sys, k)];
        for (int i = 0; i < s->n; i++) {
            const char *name = hn_scene_start_name(s->item[i].name);
            if (name && strcmp(name, c->name) == 0) {
                tell_moved(name, s->item[i].value, q[k], c->q0_param);
            } else if (name && strcmp(name, c->rate) == 0) {
                tell_moved(name, s->item[i].value, v[k], c->v0_param);
            }
        }
    }
    free(q);
}

hn_status hn_args_load_model(const hn_library *lib, const hn_args *args, const char *word,
                             bool allow_open, hn_model **out, hn_diags *diags) {
    settings *s = calloc(1, sizeof *s);
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (s) {
        s->diags = diags;
    }
    hn_status status =
        s ? hn_assignments_read(&args->set, "--set", see_setting, s, diags) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        s->overrides = true;
        status = hn_assignments_read(&args->set_over_set, "--set", see_setting, s, diags);
    }
    if (status == HN_OK) {
        hn_model_source source = {
            .settings = s->item, .n_settings = s->n, .allow_open = allow_open};

        // standard input, a file (or a link, wherever it leads), or a shipped scene
        if (strcmp(word, "-") == 0) {
            status = hn_file_read_stdin(HN_SCENE_MAX_BYTES, &text, diags);
            source.text = hn_strbuf_text(&text);
            source.n_text = text.n;
        } else if (!hn_library_scene_path(lib, word) &&
                   (strchr(word, '/') || lstat(word, &(struct stat){0}) == 0)) {
            source.path = word;
        } else if (names_json(word)) {
            status = report_no_file(lib, word, diags);
        } else {
            source.name = word;
        }
        HN_THEN(status, hn_model_load(lib, &source, out, diags));
        if (status != HN_OK && source.text) {
            hn_diags_name_file(diags, 0, "standard input");
        }
    }
    if (status == HN_OK && !args->json) {
        tell_beyond(*out);
        tell_start(*out, s);
    }
    hn_strbuf_reset(&text);
    free(s);
    return status;
}
