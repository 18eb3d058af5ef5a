// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/panels.h"

#include "base/shortest.h"
#include "base/units.h"
#include "cli/shell/glossary.h"
#include "dynamics/compile/coordinates.h"
#include "formulations/list/formulation_list.h"
#include "grade/exercise_shelf.h"
#include "integrators/list/stepper_list.h"
#include "lesson/lesson.h"
#include "lesson/lesson_text.h"
#include "session/export/export.h"
#include "session/model/equations.h"
#include "session/model/lists.h"
#include "terminal/short_spelling.h"
#include "tui/best_scores.h"
#include "tui/exercise_panel.h"
#include "tui/list.h"
#include "tui/methods.h"
#include "tui/prompt.h"
#include "tui/remedies.h"
#include "tui/remedy_words.h"
#include "tui/scene_list.h"
#include "tui/study_panel.h"
#include "tui/text_panel.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_TEXT = 100 }; // [columns] a line is easily read

// ---- lists ----

static const char *text_of(const cJSON *object, const char *name) {
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsString(item) ? item->valuestring : "";
}

static void list_methods(hn_workbench *w) {
    hn_list_begin(w, HN_LIST_METHODS, "methods: Enter changes, x removes, Esc goes back");
    w->cursor = w->selected;
    for (int i = 0; i < w->n_methods; i++) {
        char shown[HN_SPEC_MAX];
        hn_short_spelling(w->methods[i], shown, sizeof shown);
        hn_list_add(w, shown, hn_recording_track(w->recording, i)->rule);
    }
    if (w->n_methods < HN_COMPARISON_MAX_METHODS) {
        hn_list_add(w, "add a method",
                    "Enter lists the formulations; one chosen is completed with "
                    "an integrator that fits, and can be changed");
    }
}

static void list_formulations(hn_workbench *w) {
    hn_list_begin(w, HN_LIST_FORMULATIONS, "add a method: Enter chooses, Esc goes back");
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        hn_list_add(w, f->name, f->rule);
    }
}

/// Asks for the spelling of a method, beginning with this formulation, an integrator that fits it
/// and the step of the others.
static void ask_method_of(hn_workbench *w, const char *formulation) {
    static const char *const first[] = {"rk4", "radau5"};
    enum { N_FIRST = sizeof first / sizeof *first };
    const double h = isfinite(hn_methods_step(w)) ? hn_methods_step(w) : 0.01;
    char text[HN_SPEC_MAX];
    for (int i = 0; i < N_FIRST + hn_stepper_count(); i++) {
        const char *name = i < N_FIRST ? first[i] : hn_stepper_at(i - N_FIRST)->name;
        hn_method_spec spec;
        hn_diag diag = {0};
        snprintf(text, sizeof text, "%.100s@%.100s", formulation, name);
        if (hn_method_parse(text, &spec, &diag) == HN_OK) {
            double *step = hn_method_find_option(&spec, "h", NULL);
            if (step && !hn_method_is_adaptive(&spec)) {
                *step = h;
            }
            hn_method_format(&spec, text);
            break;
        }
    }
    hn_workbench_ask(w, HN_PROMPT_METHOD, text);
    w->replaces = false; // it is to be completed
}

/// A number that can be changed, with its range.
static void add_value(hn_workbench *w, const char *name, double value, const char *unit, double low,
                      double high, const char *about) {
    char line[HN_TUI_LINE];
    if (isfinite(low) && isfinite(high)) {
        snprintf(line, sizeof line, "%.9g %s   (%g to %g)  %.150s", value, unit, low, high, about);
    } else {
        snprintf(line, sizeof line, "%.9g %s   %.150s", value, unit, about);
    }
    hn_item *item = hn_list_add(w, name, line);
    if (item) {
        item->value = value;
        item->low = low;
        item->high = high;
        snprintf(item->unit, sizeof item->unit, "%s", unit);
    }
}

/// Writes where coordinates and rates start, under the names that settings give them.
static void list_starts(hn_workbench *w) {
    const hn_system *sys = hn_model_system(w->model);
    const hn_scene *scene = hn_model_scene(w->model);
    const int n = hn_system_get_info(sys).n_user;
    double *user = calloc(2 * (size_t)n + 1, sizeof *user);
    if (!user) {
        hn_workbench_say(w, "out of memory");
        return;
    }
    hn_system_to_user(sys, hn_model_q(w->model), user);
    hn_system_rates_to_user(sys, hn_model_v(w->model), user + n);
    for (int i = 0; i < 2 * n; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(sys, i % n)];
        const bool rate = i >= n, length = c->kind == HN_LENGTH;
        char name[HN_TUI_LINE];
        snprintf(name, sizeof name, "start.%.80s", rate ? c->rate : c->name);
        add_value(w, name, user[i], length ? (rate ? "m/s" : "m") : (rate ? "rad/s" : "rad"),
                  (double)NAN, (double)NAN, rate ? "rate at the start" : "at the start");
    }
    free(user);
}

static void list_parameters(hn_workbench *w) {
    const hn_scene *scene = hn_model_scene(w->model);
    hn_list_begin(w, HN_LIST_PARAMETERS, "parameters: Enter types, ←→ change, Esc goes back");
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        add_value(w, p->name, p->value, p->unit ? p->unit : "", p->min, p->max,
                  p->about ? p->about : "");
    }
    list_starts(w);
}

/// An exercise with the best score that was reached.
static void list_exercise(hn_workbench *w, const cJSON *exercise, const cJSON *scores) {
    char about[HN_TUI_LINE];
    double score, most;
    const char *id = text_of(exercise, "id"), *title = text_of(exercise, "title");
    snprintf(about, sizeof about, "%.200s", title);
    if (hn_best_scores_find(scores, id, &score, &most)) {
        snprintf(about, sizeof about, "best %g of %g: %.200s", score, most, title);
    }
    hn_item *item = hn_list_add(w, id, about);
    if (item) {
        item->is_exercise = true;
    }
}

/// A lesson, then its exercises.
static void list_lesson(hn_workbench *w, const cJSON *lesson, const cJSON *exercises,
                        const cJSON *scores) {
    const cJSON *one;
    hn_list_add(w, text_of(lesson, "id"), text_of(lesson, "title"));
    cJSON_ArrayForEach(one, exercises) {
        if (strcmp(text_of(one, "lesson"), text_of(lesson, "id")) == 0) {
            list_exercise(w, one, scores);
        }
    }
}

static void list_lessons(hn_workbench *w) {
    hn_strbuf b;
    const cJSON *lesson;
    hn_strbuf_init(&b);
    hn_lessons_json(&b, w->library);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    hn_strbuf_clear(&b);
    hn_shelf_exercises_json(&b, w->library);
    cJSON *exercises = cJSON_Parse(hn_strbuf_text(&b)), *scores = hn_best_scores_load();
    hn_list_begin(w, HN_LIST_LESSONS, "lessons and exercises: Enter opens, Esc goes back");
    cJSON_ArrayForEach(lesson, cJSON_GetObjectItem(document, "lessons")) {
        list_lesson(w, lesson, cJSON_GetObjectItem(exercises, "problems"), scores);
    }
    cJSON_Delete(scores);
    cJSON_Delete(exercises);
    cJSON_Delete(document);
    hn_strbuf_reset(&b);
}

static void list_exports(hn_workbench *w) {
    hn_strbuf b;
    const cJSON *language;
    hn_strbuf_init(&b);
    hn_export_languages_json(&b);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    hn_list_begin(w, HN_LIST_EXPORTS, "export: Enter names a file, Esc goes back");
    hn_list_add(w, HN_TUI_RECORDING, "gap, energy change and error of every method, a row a frame");
    cJSON_ArrayForEach(language, cJSON_GetObjectItem(document, "languages")) {
        hn_list_add(w, text_of(language, "name"), text_of(language, "about"));
    }
    cJSON_Delete(document);
    hn_strbuf_reset(&b);
}

/// The table of keys as a menu.
static void list_actions(hn_workbench *w) {
    const hn_tui_key *keys;
    const int n = hn_tui_keys(&keys);
    hn_list_begin(w, HN_LIST_ACTIONS, "keys: Enter does it, Esc goes back");
    for (int i = 0; i < n; i++) {
        if (keys[i].action == HN_TUI_CYCLE) {
            hn_list_add(w, "1 to 8", "select a method");
        }
        hn_list_add(w, keys[i].shown, keys[i].means);
    }
    hn_list_add(w, "in a study",
                "e the error wanted, t the time of motion, Enter takes the answer");
    hn_list_add(w, "in methods", "x removes the method, Enter changes it");
    hn_list_add(w, "mouse",
                "a joint can be dragged to another start; a click takes a time in the plot, or a "
                "method in the table");
}

// ---- texts ----

/// The formulation whose equation lacks a term; what it solves, and what it leaves out.
static const char AS_PRINTED[] = "nullspace-as-printed";
static const char MISSING_TERM[] = "it solves                  N' M N du/dt = N' f\n"
                                   "missing on the left side:  N' M (dN/dt) u\n";

static void show_equations(hn_workbench *w) {
    hn_diags diags = {0};
    hn_text_panel_open(w, "equations of motion: Esc goes back");
    for (int m = 0; m < w->n_methods; m++) { // whichever is selected
        const hn_track *track = hn_recording_track(w->recording, m);
        if (strncmp(track->spelling, AS_PRINTED, strlen(AS_PRINTED)) == 0) {
            hn_strbuf_printf(&w->text, "%s: %s\n%s\n", track->name, track->rule, MISSING_TERM);
            break;
        }
    }
    if (hn_model_equations(&w->text, w->model, HN_EQUATIONS_TEXT, &diags) != HN_OK) {
        w->panel = HN_PANEL_MAIN;
        hn_workbench_say_fault(w, &diags);
    }
}

/// What the main view says of the selected method: in it the terms are looked for.
static void add_said(hn_strbuf *b, const hn_workbench *w) {
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const hn_incident_list *list = hn_incident_list_get(w);
    hn_strbuf_printf(b, "%s\n%s\n", w->notice, track->rule ? track->rule : "");
    for (int i = 0; i < list->n; i++) {
        if (list->whose[i] == w->selected) {
            hn_strbuf_printf(b, "%s\n", list->at[i].message);
        }
    }
}

/// The glossary, terms that the view uses first.
static void show_words(hn_workbench *w) {
    int n;
    const hn_glossary_term *terms = hn_glossary(&n);
    hn_strbuf said;
    hn_strbuf_init(&said);
    add_said(&said, w);
    hn_text_panel_open(w, "words: Esc goes back");
    for (int other = 0; other < 2; other++) {
        bool first = true;
        for (int i = 0; i < n; i++) {
            if (hn_term_is_in(&terms[i], hn_strbuf_text(&said)) == (other == 0)) {
                const char *head = other ? "Other terms" : "Terms of what is said here";
                hn_strbuf_printf(&w->text, "%s%s%s%s\n    %s\n",
                                 first && other && w->text.n ? "\n" : "", first ? head : "",
                                 first ? "\n\n" : "", terms[i].word, terms[i].means);
                first = false;
            }
        }
    }
    hn_strbuf_reset(&said);
}

static void show_lesson(hn_workbench *w, const char *id) {
    cJSON *lesson = NULL;
    hn_diags diags = {0};
    if (hn_lesson_load(w->library, id, &lesson, &diags) != HN_OK) {
        hn_workbench_say_fault(w, &diags);
        return;
    }
    hn_text_panel_open(w, "lesson: Esc goes back");
    if (w->form == HN_DOTS_ASCII) {
        hn_lesson_spell_out(lesson); // from its formulas, before their lines are folded
    }
    hn_lesson_text(&w->text, lesson, w->columns > MOST_TEXT + 4 ? MOST_TEXT : w->columns - 4);
    cJSON_Delete(lesson);
}

static void show_budget(hn_workbench *w) {
    char title[HN_TUI_LINE];
    const char *words[HN_TUI_WORDS] = {"study", w->scene, "budget", "--time", "2", "--methods"};
    int n = 6;
    for (int i = 0; i < w->n_methods; i++) {
        words[n++] = w->methods[i];
    }
    snprintf(title, sizeof title, "error budget of %.180s: Esc stops and goes back", w->scene);
    hn_text_panel_run(w, title, words, n);
}

/// A lesson or an exercise, from which Escape goes back to the list.
static void open_lesson(hn_workbench *w, const hn_item *item) {
    const int cursor = w->cursor;
    (item->is_exercise ? hn_exercise_panel_open : show_lesson)(w, item->name);
    w->lesson = cursor;
}

// ---- keys of panels ----

/// Returns to the list that a panel was opened from; to the workbench where there is none.
static void go_back(hn_workbench *w) {
    const bool reads = w->panel == HN_PANEL_TEXT || w->panel == HN_PANEL_EXERCISE;
    const int lesson = w->lesson;
    hn_child_stop(&w->child);
    if (reads && lesson >= 0) {
        list_lessons(w);
        w->cursor = lesson < w->n_items ? lesson : 0;
    } else if (w->panel == HN_PANEL_LIST && w->list == HN_LIST_FORMULATIONS) {
        list_methods(w);
        w->cursor = w->n_items - 1;
    } else if (w->panel == HN_PANEL_LIST && w->over_study) {
        w->panel = HN_PANEL_STUDY;
    } else {
        w->panel = HN_PANEL_MAIN;
    }
}

/// The action of the row that the cursor of the menu is on; HN_TUI_NONE: it is a remark.
static hn_tui_action action_of_row(const hn_workbench *w) {
    const hn_tui_key *keys;
    const int n = hn_tui_keys(&keys);
    for (int i = 0; i < n; i++) {
        if (strcmp(keys[i].shown, w->items[w->cursor].name) == 0) {
            return keys[i].action;
        }
    }
    return HN_TUI_NONE;
}

/// Opens another scene with its own methods; where those that ran were others than the scene's
/// they were chosen by hand, and it is said how they come back.
static void open_scene(hn_workbench *w, const char *name) {
    char before[sizeof w->scene];
    const hn_scene *scene = hn_model_scene(w->model);
    bool chosen = scene->n_methods != w->n_methods;
    for (int i = 0; i < w->n_methods && !chosen; i++) {
        chosen = strcmp(scene->methods[i], w->methods[i]) != 0;
    }
    snprintf(before, sizeof before, "%s", w->scene);
    if (hn_workbench_reopen(w, name, NULL, 0, NULL, 0) && chosen) {
        hn_workbench_say(w, "%s has its own methods; z: back to %s with yours, at t = 0", name,
                         before);
    }
}

static void choose(hn_workbench *w) {
    const hn_item *item = &w->items[w->cursor];
    char text[HN_TUI_LINE];
    switch (w->list) {
    // another scene: the name is copied, since the list goes with the old one
    case HN_LIST_SCENES:
        snprintf(text, sizeof text, "%s", item->name);
        open_scene(w, text);
        break;

    // a value to be typed, beginning with the present one
    case HN_LIST_METHODS:
        if (w->cursor < w->n_methods) {
            hn_workbench_ask(w, HN_PROMPT_METHOD, w->methods[w->cursor]);
        } else {
            list_formulations(w);
        }
        break;
    case HN_LIST_FORMULATIONS:
        ask_method_of(w, item->name);
        break;
    case HN_LIST_PARAMETERS:
        hn_shortest_write(item->value, text);
        hn_workbench_ask(w, HN_PROMPT_PARAMETER, text);
        break;
    case HN_LIST_EXPORTS:
        hn_prompt_export(w);
        break;

    // a text to be read
    case HN_LIST_LESSONS:
        open_lesson(w, item);
        break;
    case HN_LIST_REMEDIES:
        hn_remedies_take(w);
        break;
    case HN_LIST_ACTIONS:
        w->chosen = (int)action_of_row(w);
        if (w->over_study && w->chosen != HN_TUI_NONE) {
            hn_study_panel_close(w);
            w->over_study = false;
        }
        w->panel = w->over_study ? HN_PANEL_STUDY : HN_PANEL_MAIN;
        break;
    }
}

/// A fiftieth of the range up or down, in round numbers; the list stays open.
static void nudge(hn_workbench *w, int by) {
    const hn_item *item = &w->items[w->cursor];
    const int cursor = w->cursor;
    char name[HN_TUI_LINE];
    if (w->list != HN_LIST_PARAMETERS || isnan(item->value)) {
        return;
    }
    const bool ranged = isfinite(item->low) && isfinite(item->high);
    const double step = ranged ? hn_round_125((item->high - item->low) / 50) : hn_round_125(0.05);
    double value = round((item->value + by * step) / step) * step;
    value = ranged ? fmin(item->high, fmax(item->low, value)) : value;
    snprintf(name, sizeof name, "%s", item->name);
    hn_prompt_set_parameter(w, name, value);
    list_parameters(w);
    w->cursor = cursor < w->n_items ? cursor : 0;
}

/// Returns whether the typed letters stand at the start of the text, or anywhere in it (`inside`).
static bool has_letters(const char *text, const char *letters, bool inside) {
    const size_t n = strlen(letters);
    for (bool more = true; more && *text; text++) {
        if (strncasecmp(text, letters, n) == 0) {
            return true;
        }
        more = inside;
    }
    return false;
}

/// The first item for the letters typed so far, from `from` on: its name begins with them, else has
/// them, else its description has them. -1: none.
static int find_item(const hn_workbench *w, int from) {
    enum { BEGINS, IN_NAME, IN_ABOUT, RANKS };
    for (int rank = BEGINS; rank < RANKS; rank++) {
        for (int i = 0; i < w->n_items; i++) {
            const int k = (from + i) % w->n_items;
            const hn_item *item = &w->items[k];
            const char *text = rank == IN_ABOUT ? item->about : item->name;
            if (has_letters(text, w->search, rank != BEGINS)) {
                return k;
            }
        }
    }
    return -1;
}

/// The first n letters of the search stay; the cursor goes to the item that they find.
static void find_letters(hn_workbench *w, int n) {
    w->n_search = n;
    w->search[n] = '\0';
    const int k = n > 0 ? find_item(w, w->cursor) : -1;
    if (k >= 0) {
        w->cursor = k;
        hn_workbench_say(w, "search: %s", w->search);
    } else if (n > 0) {
        hn_workbench_say(w, "no item has '%s'; Backspace takes a letter back", w->search);
    }
}

/// Takes a letter of a search, or Backspace in one. Returns whether the key is one of them.
static bool search_key(hn_workbench *w, int key) {
    const bool letter = key < 128 && (isalnum(key) || (w->n_search > 0 && isprint(key)));
    if (letter && w->n_search + 1 < (int)sizeof w->search) {
        w->search[w->n_search] = (char)key;
        find_letters(w, w->n_search + 1);
    } else if (key == HN_KEY_BACKSPACE && w->n_search > 0) {
        find_letters(w, w->n_search - 1);
    }
    return letter || key == HN_KEY_BACKSPACE;
}

/// The list stays open, so that a second x does not ask for something else.
static void remove_method(hn_workbench *w) {
    const int cursor = w->cursor;
    hn_methods_remove(w, cursor);
    if (w->panel == HN_PANEL_MAIN) {
        list_methods(w);
        w->cursor = cursor < w->n_items ? cursor : w->n_items - 1;
    }
}

static void list_key(hn_workbench *w, int key) {
    const int to = w->cursor + hn_list_step(key);
    const bool removes = key == 'x' && w->list == HN_LIST_METHODS;
    if (w->list != HN_LIST_SCENES && !removes && search_key(w, key)) {
        return;
    }
    if (w->list != HN_LIST_SCENES) { // whose letters stay in its title
        w->n_search = 0;             // another key ends the search
    }
    if (key == HN_KEY_ENTER && w->n_items > 0) {
        choose(w);
    } else if (removes) {
        remove_method(w);
    } else if (key == HN_KEY_LEFT || key == HN_KEY_RIGHT) {
        nudge(w, key == HN_KEY_RIGHT ? 1 : -1);
    } else if (hn_list_step(key) != 0) {
        w->cursor = to < 0 ? 0 : to >= w->n_items ? w->n_items - 1 : to;
    }
}

void hn_panel_key(hn_workbench *w, int key) {
    if (w->panel == HN_PANEL_STUDY && key == '?') {
        list_actions(w);
        w->over_study = true;
    } else if (w->panel == HN_PANEL_STUDY) {
        hn_study_panel_key(w, key);
    } else if (w->panel == HN_PANEL_LIST && hn_scene_list_key(w, key)) {
        // the search has taken it
    } else if (key == HN_KEY_ESCAPE || (key == 'q' && w->panel != HN_PANEL_LIST)) {
        go_back(w);
    } else if (w->panel == HN_PANEL_LIST) {
        list_key(w, key);
    } else if (w->panel == HN_PANEL_EXERCISE) {
        hn_exercise_panel_key(w, key);
    } else {
        hn_text_panel_key(w, key);
    }
}

void hn_panel_open(hn_workbench *w, hn_tui_action action) {
    static const struct {
        hn_tui_action action;
        void (*open)(hn_workbench *w);
    } panels[] = {{HN_TUI_PARAMETERS, list_parameters}, {HN_TUI_METHODS, list_methods},
                  {HN_TUI_SCENES, hn_scene_list_open},  {HN_TUI_FORMULAS, show_equations},
                  {HN_TUI_LESSONS, list_lessons},       {HN_TUI_BUDGET, show_budget},
                  {HN_TUI_EXPORT, list_exports},        {HN_TUI_GLOSSARY, show_words},
                  {HN_TUI_HELP, list_actions}};
    for (size_t i = 0; i < sizeof panels / sizeof *panels; i++) {
        if (panels[i].action == action) {
            panels[i].open(w);
        }
    }

    // a line to type, the studies
    if (action == HN_TUI_STEP) {
        char text[HN_SHORTEST_TEXT] = "";
        if (isfinite(hn_methods_step(w))) {
            hn_shortest_write(hn_methods_step(w), text);
        }
        hn_workbench_ask(w, HN_PROMPT_STEP, text);
    } else if (action == HN_TUI_STUDY || action == HN_TUI_MAP) {
        hn_study_panel_open(w, action == HN_TUI_STUDY ? HN_TUI_COST : HN_TUI_STABILITY);
    }
}
