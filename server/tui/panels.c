// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/panels.h"

#include "lesson/lesson.h"
#include "lesson/lesson_text.h"
#include "session/model/lists.h"
#include "session/model/equations.h"
#include "session/model/model_json.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LESSON_COLUMNS = 78 };

// ---- lists ----

static void begin_list(hn_workbench *w, hn_list_kind kind, const char *title) {
    w->panel = HN_PANEL_LIST;
    w->list = kind;
    w->n_items = w->cursor = w->scroll = 0;
    snprintf(w->title, sizeof w->title, "%s", title);
}

static void add_item(hn_workbench *w, const char *name, const char *about) {
    if (w->n_items < HN_TUI_ITEMS) {
        hn_item *item = &w->items[w->n_items++];
        snprintf(item->name, sizeof item->name, "%s", name);
        snprintf(item->about, sizeof item->about, "%s", about ? about : "");
    }
}

static const char *text_of(const cJSON *object, const char *name) {
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsString(item) ? item->valuestring : "";
}

static void list_scenes(hn_workbench *w) {
    hn_strbuf b;
    const cJSON *scene;
    hn_strbuf_init(&b);
    hn_scenes_json(&b, w->library);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    begin_list(w, HN_LIST_SCENES, "scenes: Enter opens, Esc goes back");
    cJSON_ArrayForEach(scene, cJSON_GetObjectItem(document, "scenes")) {
        add_item(w, text_of(scene, "id"), text_of(scene, "title"));
        if (strcmp(text_of(scene, "id"), w->scene) == 0) {
            w->cursor = w->n_items - 1;
        }
    }
    cJSON_Delete(document);
    hn_strbuf_reset(&b);
}

static void list_methods(hn_workbench *w) {
    begin_list(w, HN_LIST_METHODS, "methods: Enter changes, x removes, Esc goes back");
    for (int i = 0; i < w->n_methods; i++) {
        add_item(w, w->methods[i], hn_recording_track(w->recording, i)->rule);
    }
    if (w->n_methods < HN_COMPARISON_MAX_METHODS) {
        add_item(w, "add a method", "FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...]");
    }
}

static void list_parameters(hn_workbench *w) {
    const hn_scene *scene = hn_model_scene(w->model);
    begin_list(w, HN_LIST_PARAMETERS, "parameters: Enter changes, Esc goes back");
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        char line[HN_TUI_LINE];
        snprintf(line, sizeof line, "%.9g %s   (%g to %g)  %.150s", p->value,
                 p->unit ? p->unit : "", p->min, p->max, p->about ? p->about : "");
        add_item(w, p->name, line);
    }
}

static void list_lessons(hn_workbench *w) {
    hn_strbuf b;
    const cJSON *lesson;
    hn_strbuf_init(&b);
    hn_lessons_json(&b, w->library);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&b));
    begin_list(w, HN_LIST_LESSONS, "lessons: Enter reads, Esc goes back");
    cJSON_ArrayForEach(lesson, cJSON_GetObjectItem(document, "lessons")) {
        add_item(w, text_of(lesson, "id"), text_of(lesson, "title"));
    }
    cJSON_Delete(document);
    hn_strbuf_reset(&b);
}

// ---- texts ----

static void begin_text(hn_workbench *w, const char *title) {
    hn_child_stop(&w->child);
    w->panel = HN_PANEL_TEXT;
    w->scroll = 0;
    hn_strbuf_clear(&w->text);
    snprintf(w->title, sizeof w->title, "%s", title);
}

static void show_help(hn_workbench *w) {
    const hn_tui_key *keys;
    const int n = hn_tui_keys(&keys);
    begin_text(w, "keys: Esc goes back");
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(&w->text, "%-*s %s\n",
                         12 + (int)strlen(keys[i].shown) - hn_text_columns(keys[i].shown),
                         keys[i].shown, keys[i].means);
    }
    hn_strbuf_add(&w->text,
                  "1 to 8       select a method\n\n"
                  "gap     how far the loop stands open: the size of the constraint violation [m]\n"
                  "error   largest distance of a drawn point from the reference solution [m]\n"
                  "energy  change of the energy since the start, less the work\n"
                  "        of drives, dampers and loads [J]\n\n"
                  "The mouse selects a method in the table and a time in the plot.\n");
}

static void show_equations(hn_workbench *w) {
    hn_diags diags = {0};
    begin_text(w, "equations of motion: Esc goes back");
    if (hn_model_equations(&w->text, w->model, HN_EQUATIONS_TEXT, &diags) != HN_OK) {
        w->panel = HN_PANEL_MAIN;
        hn_workbench_say_fault(w, &diags);
    }
}

static void show_lesson(hn_workbench *w, const char *id) {
    cJSON *lesson = NULL;
    hn_diags diags = {0};
    if (hn_lesson_load(w->library, id, &lesson, &diags) != HN_OK) {
        hn_workbench_say_fault(w, &diags);
        return;
    }
    begin_text(w, "lesson: Esc goes back");
    hn_lesson_text(&w->text, lesson, LESSON_COLUMNS);
    cJSON_Delete(lesson);
}

/// Runs a study of this scene beside the workbench; its text is shown as it comes.
static void run_study(hn_workbench *w, const char *kind, const char *option, const char *value) {
    char settings[HN_TUI_SETTINGS][128];
    const char *arguments[16 + 2 * HN_TUI_SETTINGS + HN_COMPARISON_MAX_METHODS] = {"study",
                                                                                   w->scene, kind};
    int n = 3;
    if (option) {
        arguments[n++] = option;
        arguments[n++] = value;
    }
    for (int i = 0; i < w->n_settings; i++) {
        snprintf(settings[i], sizeof settings[i], "%s=%.17g", w->settings[i].name,
                 w->settings[i].value);
        arguments[n++] = "--set";
        arguments[n++] = settings[i];
    }

    // the panel names it; Esc stops it
    char title[HN_TUI_LINE];
    snprintf(title, sizeof title, "%s of %.180s: Esc stops and goes back", kind, w->scene);
    begin_text(w, title);
    hn_strbuf_printf(&w->text, "holonom study %s %s\n\n", w->scene, kind);
    if (!hn_child_start(&w->child, arguments)) {
        hn_workbench_say(w, "the study could not be started");
    }
}

// ---- prompts ----

static void begin_prompt(hn_workbench *w, hn_prompt_kind kind, const char *initial) {
    w->prompt = kind;
    w->n_input = snprintf(w->input, sizeof w->input, "%s", initial);
}

/// Writes the value of `key` behind the integrator of a spelling, in place of the one that stands
/// there.
static void set_integrator_option(char spelling[HN_SPEC_MAX], const char *key, double value) {
    char head[HN_SPEC_MAX], rest[2 * HN_SPEC_MAX] = "", find[32];
    snprintf(find, sizeof find, "%s=", key);
    char *at = strchr(spelling, '@');
    char *colon = at ? strchr(at, ':') : NULL;
    if (!at) {
        return;
    }
    // the other options are kept in their order
    snprintf(head, sizeof head, "%.*s", colon ? (int)(colon - spelling) : (int)strlen(spelling),
             spelling);
    for (char *option = colon ? strtok(colon + 1, ",") : NULL; option; option = strtok(NULL, ",")) {
        if (strncmp(option, find, strlen(find)) != 0) {
            const size_t used = strlen(rest);
            snprintf(rest + used, sizeof rest - used, ",%.250s", option);
        }
    }
    snprintf(spelling, HN_SPEC_MAX, "%.180s:%s%.9g%.40s", head, find, value, rest);
}

static void record_again(hn_workbench *w, char before[][HN_SPEC_MAX], int n_before) {
    hn_diags diags = {0};
    if (hn_workbench_record(w, &diags) != HN_OK) {
        memcpy(w->methods, before, (size_t)n_before * sizeof *before);
        w->n_methods = n_before;
        hn_workbench_say_fault(w, &diags);
    }
    w->panel = HN_PANEL_MAIN;
}

static void accept_step(hn_workbench *w) {
    char before[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    char *end;
    for (char *c = w->input; *c; c++) {
        *c = *c == ',' ? '.' : *c;
    }
    const double h = strtod(w->input, &end);
    const double scale = strncmp(end + strspn(end, " "), "ms", 2) == 0 ? 1e-3 : 1;
    if (end == w->input || !(h > 0) || !isfinite(h)) {
        hn_workbench_say(w, "dt must be above 0 s; '%.40s' is not. Try 0.01 or 20 ms", w->input);
        return;
    }
    memcpy(before, w->methods, sizeof before);
    for (int i = 0; i < w->n_methods; i++) {
        if (!strstr(w->methods[i], "tol=")) {
            set_integrator_option(w->methods[i], "h", h * scale);
        }
    }
    record_again(w, before, w->n_methods);
}

static void accept_method(hn_workbench *w) {
    char before[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    const int n = w->n_methods, at = w->cursor < n ? w->cursor : n;
    memcpy(before, w->methods, sizeof before);
    snprintf(w->methods[at], HN_SPEC_MAX, "%.250s", w->input);
    w->n_methods = at == n ? n + 1 : n;
    record_again(w, before, n);
}

static void accept_parameter(hn_workbench *w) {
    char *end;
    const double value = strtod(w->input, &end);
    const char *name = w->items[w->cursor].name;
    if (end == w->input || *end || !isfinite(value)) {
        hn_workbench_say(w, "%s: '%.40s' is not a number", name, w->input);
        return;
    }
    hn_setting settings[HN_TUI_SETTINGS + 1];
    int n = 0;
    for (int i = 0; i < w->n_settings; i++) {
        if (strcmp(w->settings[i].name, name) != 0) {
            settings[n++] = w->settings[i];
        }
    }
    settings[n++] = (hn_setting){name, value};
    hn_workbench_reopen(w, w->scene, settings, n, true);
}

/// One row a frame: time, then gap, energy and error of each method, in a file that was not there.
static void accept_export(hn_workbench *w) {
    FILE *file = fopen(w->input, "wx");
    if (!file) {
        hn_workbench_say(w, "%.200s: cannot be written, or is there already; type another name",
                         w->input);
        return;
    }
    fprintf(file, "t");
    for (int m = 0; m < w->n_methods; m++) {
        const char *s = hn_recording_track(w->recording, m)->spelling;
        fprintf(file, ",\"gap %s\",\"energy change %s\",\"error %s\"", s, s, s);
    }
    fprintf(file, "\n");

    // one row a frame; what is not known stays empty
    const int n = hn_recording_frames(w->recording);
    for (int k = 0; k < n; k++) {
        fprintf(file, "%.17g", k * hn_recording_frame_dt(w->recording));
        for (int m = 0; m < w->n_methods; m++) {
            const hn_track *t = hn_recording_track(w->recording, m);
            const double values[] = {t->gap[k], t->energy[k], t->error[k]};
            for (int i = 0; i < 3; i++) {
                fprintf(file, isfinite(values[i]) ? ",%.17g" : ",", values[i]);
            }
        }
        fprintf(file, "\n");
    }

    // only a file that was closed well is complete
    const bool good = fclose(file) == 0;
    hn_workbench_say(w, good ? "%.200s: %d frames written" : "%.200s: the disk is full; %d frames",
                     w->input, n);
}

void hn_prompt_key(hn_workbench *w, int key) {
    static void (*const accept[])(hn_workbench *) = {[HN_PROMPT_STEP] = accept_step,
                                                     [HN_PROMPT_METHOD] = accept_method,
                                                     [HN_PROMPT_PARAMETER] = accept_parameter,
                                                     [HN_PROMPT_EXPORT] = accept_export};

    // Escape forgets the line, Enter hands it over
    if (key == HN_KEY_ESCAPE) {
        w->prompt = HN_PROMPT_NONE;
    } else if (key == HN_KEY_ENTER) {
        const hn_prompt_kind kind = w->prompt;
        w->prompt = HN_PROMPT_NONE;
        accept[kind](w);
    } else if (key == HN_KEY_BACKSPACE && w->n_input > 0) {
        w->input[--w->n_input] = '\0';
    } else if (key >= 32 && key < 127 && w->n_input < HN_TUI_LINE - 1) {
        w->input[w->n_input++] = (char)key;
        w->input[w->n_input] = '\0';
    }
}

// ---- keys of panels ----

static void choose(hn_workbench *w) {
    const hn_scene *scene = hn_model_scene(w->model);
    switch (w->list) {
    // another scene: the name is copied, since the list goes with the old one
    case HN_LIST_SCENES: {
        char name[HN_TUI_LINE];
        snprintf(name, sizeof name, "%s", w->items[w->cursor].name);
        hn_workbench_reopen(w, name, NULL, 0, false);
        break;
    }

    // a value to be typed, beginning with the present one
    case HN_LIST_METHODS:
        begin_prompt(w, HN_PROMPT_METHOD, w->cursor < w->n_methods ? w->methods[w->cursor] : "");
        break;
    case HN_LIST_PARAMETERS: {
        char value[40];
        snprintf(value, sizeof value, "%.17g", scene->params[w->cursor].value);
        begin_prompt(w, HN_PROMPT_PARAMETER, value);
        break;
    }

    // a text to be read
    case HN_LIST_LESSONS:
        show_lesson(w, w->items[w->cursor].name);
        break;
    }
}

static void remove_method(hn_workbench *w) {
    char before[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    const int n = w->n_methods;
    if (w->list != HN_LIST_METHODS || w->cursor >= n || n < 2) {
        return;
    }
    memcpy(before, w->methods, sizeof before);
    memmove(w->methods[w->cursor], w->methods[w->cursor + 1],
            (size_t)(n - w->cursor - 1) * sizeof *before);
    w->n_methods = n - 1;
    record_again(w, before, n);
}

/// How far a key moves in a list or a text; 0: it does not.
static int step_of(int key) {
    switch (key) {
    case HN_KEY_UP:
        return -1;
    case HN_KEY_DOWN:
        return 1;
    case HN_KEY_PAGE_UP:
        return -15;
    case HN_KEY_PAGE_DOWN:
        return 15;
    case HN_KEY_HOME:
        return -1000000;
    case HN_KEY_END:
        return 1000000;
    default:
        return 0;
    }
}

/// A letter goes to the next item that begins with it.
static void find_letter(hn_workbench *w, int key) {
    for (int i = 1; i <= w->n_items; i++) {
        const int k = (w->cursor + i) % w->n_items;
        if (tolower((unsigned char)w->items[k].name[0]) == tolower(key)) {
            w->cursor = k;
            return;
        }
    }
}

static void list_key(hn_workbench *w, int key) {
    const int to = w->cursor + step_of(key);
    if (key == HN_KEY_ENTER && w->n_items > 0) {
        choose(w);
    } else if (key == 'x' && w->list == HN_LIST_METHODS) {
        remove_method(w);
    } else if (step_of(key) != 0) {
        w->cursor = to < 0 ? 0 : to >= w->n_items ? w->n_items - 1 : to;
    } else if (key < 128 && isalnum(key)) {
        find_letter(w, key);
    }
}

void hn_panel_key(hn_workbench *w, int key) {
    if (key == HN_KEY_ESCAPE || (key == 'q' && w->panel == HN_PANEL_TEXT)) {
        hn_child_stop(&w->child);
        w->panel = HN_PANEL_MAIN;
    } else if (w->panel == HN_PANEL_LIST) {
        list_key(w, key);
    } else {
        const int to = w->scroll + (key == ' ' ? 15 : step_of(key));
        w->scroll = to < 0 ? 0 : to;
    }
}

void hn_panel_open(hn_workbench *w, hn_tui_action action) {
    switch (action) {
    // lists and prompts
    case HN_TUI_STEP:
        begin_prompt(w, HN_PROMPT_STEP, "");
        break;
    case HN_TUI_PARAMETERS:
        list_parameters(w);
        break;
    case HN_TUI_METHODS:
        list_methods(w);
        break;
    case HN_TUI_SCENES:
        list_scenes(w);
        break;
    case HN_TUI_FORMULAS:
        show_equations(w);
        break;
    case HN_TUI_LESSONS:
        list_lessons(w);
        break;

    // studies beside the workbench
    case HN_TUI_STUDY:
        run_study(w, "work-precision", "--time", "2");
        break;
    case HN_TUI_MAP:
        run_study(w, "stability", "--preset", "baumgarte");
        break;
    case HN_TUI_BUDGET:
        run_study(w, "budget", NULL, NULL);
        break;

    // files and help
    case HN_TUI_EXPORT:
        begin_prompt(w, HN_PROMPT_EXPORT, "recording.csv");
        break;
    case HN_TUI_HELP:
        show_help(w);
        break;
    default:
        break;
    }
}
