// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/prompt.h"

#include "base/shortest.h"
#include "grade/parts/unit_text.h"
#include "session/precision/wanted.h"
#include "terminal/keys.h"
#include "tui/exercise_panel.h"
#include "tui/methods.h"
#include "tui/study_panel.h"
#include "tui/text_panel.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void hn_prompt_export(hn_workbench *w) {
    static const struct {
        const char *language, *suffix;
    } suffixes[] = {{"python", ".py"},  {"octave", ".m"},    {"java", ".java"},
                    {"julia", ".jl"},   {"c", ".c"},         {"cpp", ".cpp"},
                    {"wolfram", ".wl"}, {"modelica", ".mo"}, {"latex", ".tex"}};
    const char *name = w->items[w->cursor].name, *suffix = ".csv";
    char file[HN_TUI_LINE];
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        suffix = strcmp(suffixes[i].language, name) == 0 ? suffixes[i].suffix : suffix;
    }

    // a name made of the scene's, in which a program can be called so
    const char *scene = hn_model_scene(w->model)->id;
    snprintf(file, sizeof file, "%.100s%s", strcmp(name, HN_TUI_RECORDING) == 0 ? name : scene,
             suffix);
    for (char *c = file; *c; c++) {
        *c = *c == '-' ? '_' : *c;
    }
    hn_workbench_ask(w, HN_PROMPT_EXPORT, file);
}

// ---- what is done with a line ----

static bool accept_step(hn_workbench *w) {
    return hn_methods_set_step(w, w->input);
}

static bool accept_method(hn_workbench *w) {
    const bool there = w->list == HN_LIST_METHODS && w->cursor < w->n_methods;
    return hn_methods_put(w, there ? w->cursor : w->n_methods, w->input);
}

bool hn_prompt_set_parameter(hn_workbench *w, const char *name, double value) {
    hn_setting settings[HN_TUI_SETTINGS + 1];
    int n = 0;
    for (int i = 0; i < w->n_settings; i++) {
        if (strcmp(w->settings[i].name, name) != 0) {
            settings[n++] = w->settings[i];
        }
    }
    if (n == HN_TUI_SETTINGS) {
        hn_workbench_say(w, "%d changed parameters are kept at most", n);
        return false;
    }
    settings[n++] = (hn_setting){name, value};
    return hn_workbench_set(w, settings, n);
}

/// Reads "0.45", "45 cm" or "30deg" in the unit of the parameter.
static bool read_value(const char *text, const char *unit, double *out) {
    hn_unit typed, own;
    char *end;
    const double value = strtod(text, &end);
    const bool number = end != text && isfinite(value);
    end += strspn(end, " ");
    *out = value;
    if (!number || *end == '\0') {
        return number;
    }
    if (!hn_unit_parse(end, &typed) || !hn_unit_parse(unit, &own) || !hn_unit_fits(&typed, &own)) {
        return false;
    }
    *out = value * hn_unit_ratio(&typed, &own);
    return isfinite(*out);
}

static bool accept_parameter(hn_workbench *w) {
    const hn_item *item = &w->items[w->cursor];
    char name[HN_TUI_LINE];
    double value;
    for (char *c = w->input; *c; c++) {
        *c = *c == ',' ? '.' : *c;
    }
    snprintf(name, sizeof name, "%s", item->name);
    if (!read_value(w->input, item->unit, &value)) {
        hn_workbench_say(w, "%s: '%.40s' is not a number%s%s", name, w->input,
                         item->unit[0] ? " in a unit that fits " : "", item->unit);
        return false;
    }
    char unit[32], text[HN_SHORTEST_TEXT];
    snprintf(unit, sizeof unit, "%s%.30s", item->unit[0] ? " " : "", item->unit);
    if (!hn_prompt_set_parameter(w, name, value)) {
        return false;
    }
    hn_shortest_write(value, text);
    hn_workbench_say(w, "%s = %s%s: the methods start again; p changes another one", name, text,
                     unit);
    return true;
}

/// The shortest text that reads back the same; what is not known stays empty.
static void write_number(FILE *file, const char *before, double value) {
    char text[HN_SHORTEST_TEXT] = "";
    if (isfinite(value)) {
        hn_shortest_write(value, text);
    }
    fprintf(file, "%s%s", before, text);
}

/// One row a frame: time, then gap, energy and error of each method, in a file that was not there.
static bool write_recording(hn_workbench *w) {
    FILE *file = fopen(w->input, "wx");
    if (!file) {
        hn_workbench_say(w, "%.200s: %s; type another name", w->input,
                         errno == EEXIST ? "is there already" : strerror(errno));
        return false;
    }
    fprintf(file, "t");
    for (int m = 0; m < w->n_methods; m++) {
        const char *s = hn_recording_track(w->recording, m)->spelling;
        fprintf(file, ",\"gap %s\",\"energy change %s\",\"error %s\"", s, s, s);
    }
    fprintf(file, "\n");

    // one row a frame; what is not known stays empty
    hn_recording_update(w->recording);
    const int n = hn_recording_frames(w->recording);
    for (int k = 0; k < n; k++) {
        write_number(file, "", hn_recording_time(w->recording, k));
        for (int m = 0; m < w->n_methods; m++) {
            const hn_track *t = hn_recording_track(w->recording, m);
            const double values[] = {t->gap[k], t->energy[k], t->error[k]};
            for (int i = 0; i < 3; i++) {
                write_number(file, ",", values[i]);
            }
        }
        fprintf(file, "\n");
    }

    // only a file that was closed well is complete
    const bool good = fclose(file) == 0;
    if (good) {
        hn_workbench_say(w, "%.200s: %d frames written, to t = %.4g s of %.4g s", w->input, n,
                         hn_recording_time(w->recording, n - 1),
                         hn_recording_duration(w->recording));
    } else {
        hn_workbench_say(w, "%.200s: the disk is full; %d frames", w->input, n);
    }
    return good;
}

/// The recording, or the scene as a program in the chosen language.
static bool accept_export(hn_workbench *w) {
    const char *chosen = w->items[w->cursor].name;
    if (strcmp(chosen, HN_TUI_RECORDING) == 0) {
        const bool written = write_recording(w);
        w->panel = written ? HN_PANEL_MAIN : w->panel;
        return written;
    }
    FILE *there = fopen(w->input, "r");
    if (there) {
        fclose(there);
        hn_workbench_say(w, "%.200s: is there already; type another name", w->input);
        return false;
    }
    const char *const words[] = {"export", w->scene, "--language", chosen, "--out", w->input};
    hn_text_panel_run(w, "export: Esc goes back", words, 6);
    snprintf(w->writes, sizeof w->writes, "%s", w->input);
    return true;
}

/// The error for which the cheapest method is wanted; the study says which that is.
static bool accept_wanted(hn_workbench *w) {
    hn_wanted read;
    if (!hn_wanted_read(w->input, 1, &read)) {
        hn_workbench_say(w, "'%.40s' is no error above 0; type one as 1 mm, 0.1 %%, 1 mrad or 1e-3",
                         w->input);
        return false;
    }
    snprintf(w->wanted, sizeof w->wanted, "%.31s", w->input);
    w->scroll = 0;
    return true;
}

static bool accept_study_time(hn_workbench *w) {
    return hn_study_panel_set_time(w, w->input);
}

static bool accept_answer(hn_workbench *w) {
    hn_exercise_panel_accept(w);
    return true;
}

/// Cuts the line after its first n characters.
static void cut_input(hn_workbench *w, int n) {
    w->n_input = n;
    w->input[n] = '\0';
}

/// Returns where the last word of the line begins.
static int last_word(const hn_workbench *w) {
    int n = w->n_input;
    while (n > 0 && w->input[n - 1] == ' ') {
        n--;
    }
    while (n > 0 && w->input[n - 1] != ' ') {
        n--;
    }
    return n;
}

/// The first letter replaces what was filled in, as it does selected text.
static void add_letter(hn_workbench *w, bool replaces, char letter) {
    if (replaces) {
        cut_input(w, 0);
    }
    if (w->n_input < HN_TUI_LINE - 1) {
        w->input[w->n_input++] = letter;
        w->input[w->n_input] = '\0';
    }
}

void hn_prompt_key(hn_workbench *w, int key) {
    static bool (*const accept[])(hn_workbench *) = {[HN_PROMPT_STEP] = accept_step,
                                                     [HN_PROMPT_METHOD] = accept_method,
                                                     [HN_PROMPT_PARAMETER] = accept_parameter,
                                                     [HN_PROMPT_EXPORT] = accept_export,
                                                     [HN_PROMPT_ANSWER] = accept_answer,
                                                     [HN_PROMPT_WANTED] = accept_wanted,
                                                     [HN_PROMPT_STUDY_TIME] = accept_study_time};

    const bool replaces = w->replaces;
    w->replaces = false;

    // Escape forgets the line, Enter hands it over; one that is refused stays as it was typed
    if (key == HN_KEY_ESCAPE) {
        w->prompt = HN_PROMPT_NONE;
    } else if (key == HN_KEY_ENTER) {
        const hn_prompt_kind kind = w->prompt;
        w->prompt = HN_PROMPT_NONE;
        w->prompt = accept[kind](w) ? w->prompt : kind;
    } else if (key == HN_KEY_BACKSPACE && w->n_input > 0) {
        cut_input(w, w->n_input - 1);
    } else if (key == HN_KEY_CTRL_U) {
        cut_input(w, 0);
    } else if (key == HN_KEY_CTRL_W) {
        cut_input(w, last_word(w));
    } else if (key >= 32 && key < 127) {
        add_letter(w, replaces, (char)key);
    }
}
