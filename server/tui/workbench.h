// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_WORKBENCH_H
#define HN_TUI_WORKBENCH_H
// The data of the terminal workbench: a model, its recording, the selection, and the open panel.
// Keys and the mouse change it, time advances it, views (views.h) draw it; it knows neither a
// screen nor a clock.

#include "session/model/envelope.h"
#include "terminal/dots.h"
#include "tui/child.h"
#include "tui/exercise.h"
#include "tui/joint_forces.h"
#include "tui/pictures.h"
#include "tui/recording.h"
#include "tui/step_trial.h"
#include "tui/study_job.h"

#include <cjson/cJSON.h>

typedef enum hn_panel {
    HN_PANEL_MAIN,
    HN_PANEL_LIST,    ///< scenes, methods, parameters, actions to choose from
    HN_PANEL_TEXT,    ///< a text to scroll: equations, a lesson, an error budget
    HN_PANEL_STUDY,   ///< the plot of a study, while it is computed
    HN_PANEL_EXERCISE ///< a text with a field for each part of an exercise
} hn_panel;

typedef enum hn_list_kind {
    HN_LIST_SCENES,
    HN_LIST_METHODS,
    HN_LIST_FORMULATIONS, ///< of a method that is added
    HN_LIST_PARAMETERS,
    HN_LIST_LESSONS,
    HN_LIST_EXPORTS,
    HN_LIST_ACTIONS,
    HN_LIST_REMEDIES
} hn_list_kind;
typedef enum hn_prompt_kind {
    HN_PROMPT_NONE,
    HN_PROMPT_STEP,
    HN_PROMPT_METHOD,
    HN_PROMPT_PARAMETER,
    HN_PROMPT_EXPORT,
    HN_PROMPT_ANSWER,
    HN_PROMPT_WANTED,
    HN_PROMPT_STUDY_TIME
} hn_prompt_kind;
typedef enum hn_tui_plot { HN_TUI_GAP, HN_TUI_ERROR, HN_TUI_ENERGY, HN_TUI_PLOTS } hn_tui_plot;

enum { HN_TUI_LINE = 256, HN_TUI_ITEMS = 400, HN_TUI_MESSAGE = 800, HN_TUI_SETTINGS = 64 };

typedef struct hn_item {
    char name[HN_TUI_LINE], about[HN_TUI_LINE];
    char more[4 * HN_TUI_LINE]; ///< below the list in place of `about`; "": about itself
    double value, low, high;    ///< of a parameter
    char unit[32];              ///< of `value`; "": a pure number
    bool is_exercise;           ///< in the list of lessons
} hn_item;

/// A scene as it stands at its start, for the list of scenes.
typedef struct hn_preview {
    char scene[HN_TUI_LINE]; ///< whose it is; "": none yet
    hn_model *model;         ///< owned; NULL: it cannot be shown
    hn_envelope envelope;
    double *points; ///< owned
} hn_preview;

/// A mechanism that is dragged: the start that it would have when it is let go.
typedef struct hn_tui_drag {
    bool on, moved;
    int point;      ///< of the drawing
    double *points; ///< 3 a point, owned; NULL before the first move
    int n_state;
    char names[HN_TUI_SETTINGS][64]; ///< coordinates and rates
    double state[HN_TUI_SETTINGS];
    char held[HN_DIAG_MESSAGE]; ///< why it does not follow; ""
} hn_tui_drag;

/// From the plane of the view to dots of an area (HN_DOTS_ACROSS by HN_DOTS_DOWN a cell).
typedef struct hn_placing {
    double across, down; ///< dots a metre
    double x, y;         ///< dot of the view's origin
} hn_placing;

/// Box that the view has been fitted to (view_box.h).
typedef struct hn_view_box {
    double envelope[4]; ///< of the motion: minimum right and up, maximum right and up [m]
    int frames;         ///< of the recording that the view holds
    char *is_drawn;     ///< n_points, owned; NULL before the first recording
} hn_view_box;

/// The worst numbers of a method up to a moment.
typedef struct hn_tui_worst {
    double gap, energy; ///< [m], [J]
    double stopped;     ///< when it ended before that moment [s]; NaN: it did not
} hn_tui_worst;

/// A changed method, whose numbers before the change are said beside those after it.
typedef struct hn_tui_change {
    bool open; ///< the new numbers are not recorded yet
    int method;
    double t; ///< until when [s]
    hn_tui_worst before;
    char what[HN_TUI_LINE];    ///< "alpha = 20, beta = 20"
    char said[HN_TUI_MESSAGE]; ///< until the new numbers are there
} hn_tui_change;

/// The answer of a study of what accuracy costs.
typedef struct hn_tui_cheapest {
    double time;              ///< of motion [s]; 0: none
    char wanted[32];          ///< the error, as it was typed
    char method[HN_SPEC_MAX]; ///< "nullspace@rk4"
} hn_tui_cheapest;

typedef struct hn_versions hn_versions;

typedef struct hn_workbench {
    const hn_library *library;
    char scene[HN_TUI_LINE]; ///< shipped name or path
    hn_setting settings[HN_TUI_SETTINGS];
    char setting_names[HN_TUI_SETTINGS][64];
    int n_settings;
    hn_versions *versions; ///< owned: what can be undone (versions.h)
    hn_model *model;
    hn_recording *recording;
    bool computes;        ///< a reference is computed where none is stored
    hn_envelope envelope; ///< its box widens with the recording
    hn_view_box view_box;
    char methods[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    int n_methods;

    // what is shown
    double clock, speed; ///< [frames] now; times real time
    double moment;       ///< [s] asked for last: frames of another length may not hit it
    double late;         ///< [s] for which the clock has been waiting for frames without a pause
    bool playing, quit;
    int selected;
    bool hidden[HN_COMPARISON_MAX_METHODS];
    bool why, reactions;       ///< in place of the plot, one of them at most
    int why_first, why_of;     ///< of `why`: its uppermost line, while this method is selected
    hn_step_trial *step_trial; ///< of `why`; owned, NULL: none
    char untried[HN_SPEC_MAX]; ///< the method whose trial could not start
    hn_joint_forces *forces;   ///< of `reactions`; owned, NULL while not needed
    hn_tui_plot plot;
    hn_dot_form form;
    hn_pictures pictures; ///< in place of characters, for the mechanism
    hn_placing place;     ///< of the mechanism in the picture; across 0: no picture yet
    char message[HN_TUI_MESSAGE];
    char notice[HN_TUI_MESSAGE]; ///< the incident that is news; "": none
    int notice_of;               ///< method whose it is
    hn_strbuf link;              ///< for the clipboard
    bool copy;                   ///< the screen takes the link and puts this back
    int columns, rows;           ///< of the screen
    hn_tui_change change;
    hn_tui_drag drag;

    // the panel over it
    hn_panel panel;
    hn_list_kind list;
    int lesson;     ///< item of the list of lessons whose text this is; -1: none
    hn_item *items; ///< HN_TUI_ITEMS, owned
    int n_items, cursor, scroll;
    char title[HN_TUI_LINE];
    cJSON *scenes; ///< the library's list of scenes, owned; NULL before it is opened first
    char search[64];
    int n_search; ///< letters that are looked for in the list of scenes
    hn_strbuf text;
    int marked;                ///< line of the text that is marked; -1: none
    hn_tui_exercise *exercise; ///< the one that was opened last; owned, NULL: none
    hn_child child;            ///< the command whose text this is, while it runs
    char writes[HN_TUI_LINE];  ///< the file that this command writes; "": none
    hn_preview preview;
    hn_tui_study *study;               ///< of its panel; owned, NULL otherwise
    hn_tui_study *longer;              ///< the same over the whole motion, behind it; owned or NULL
    bool longer_failed;                ///< it could not be computed
    bool over_study;                   ///< the menu lies over that panel
    double study_time[HN_TUI_STUDIES]; ///< [s] of motion that was typed for each kind; 0: none
    hn_tui_cheapest cheapest;          ///< of the study of another length before this one
    char wanted[32];                   ///< error that is wanted of a method, as it was typed
    double present[2];                 ///< alpha and beta of the method that a map is about
    hn_map_place at;                   ///< cursor of a map
    int map_rows;                      ///< of a map, as it was started

    int chosen; ///< hn_tui_action chosen in the menu, to be done; 0: none

    hn_prompt_kind prompt;
    char input[HN_TUI_LINE];
    int n_input;
    bool replaces; ///< the line is as it was filled in: the first letter replaces it
} hn_workbench;

/// Opens a scene by its name or path, with changed parameters (copied). methods: n spellings; 0:
/// the scene's own. On failure nothing is open and diags say why.
HN_MUST_CHECK hn_status hn_workbench_open(hn_workbench *w, const hn_library *library,
                                          const char *scene, const hn_setting *settings,
                                          int n_settings, const char *const *methods, int n_methods,
                                          hn_diags *diags);
void hn_workbench_close(hn_workbench *w);

/// Time goes on by `seconds`: the recording is asked for what comes, and the clock moves as far as
/// there are frames.
void hn_workbench_tick(hn_workbench *w, double seconds);
/// Shows the frame at t [s], as soon as it is recorded.
void hn_workbench_go_to(hn_workbench *w, double t);
/// The moment [s] that was asked for while its frame is shown, otherwise the time of the clock.
double hn_workbench_moment(const hn_workbench *w);
/// The frame shown.
int hn_workbench_frame(const hn_workbench *w);
/// Records the methods anew; on failure what was recorded stays.
HN_MUST_CHECK hn_status hn_workbench_record(hn_workbench *w, hn_diags *diags);
/// Opens a scene in place of the present one, with n methods (0: its own). On failure the present
/// one stays, the fault is said, and false is returned.
bool hn_workbench_reopen(hn_workbench *w, const char *scene, const hn_setting *settings,
                         int n_settings, const char *const *methods, int n_methods);
/// The same scene with other settings and the same methods.
bool hn_workbench_set(hn_workbench *w, const hn_setting *settings, int n_settings);
/// Finds what the trial of shorter steps says of the selected method; false: there is none.
bool hn_workbench_step_report(const hn_workbench *w, hn_step_report *out);
/// Whether nothing but the drift of an open loop explains the errors of a method: a shorter step
/// only slows it.
bool hn_workbench_only_drifts(const hn_workbench *w, const char *spelling);
/// Returns the source of the present model; borrowed.
hn_model_source hn_workbench_source(const hn_workbench *w);
/// Begins a line to type, with `initial` in it (prompt.h).
void hn_workbench_ask(hn_workbench *w, hn_prompt_kind kind, const char *initial);
void hn_workbench_say(hn_workbench *w, const char *format, ...) HN_PRINTF(2, 3);
void hn_workbench_say_fault(hn_workbench *w, const hn_diags *diags);
#endif
