// SPDX-License-Identifier: GPL-3.0-or-later
// A predicted configuration: where the links stand when one coordinate has a given value, or at a
// time of the motion. The answer is compared with the configuration that the program assembles or
// simulates; the one that is assembled from the answer itself shows whether it is another branch.
//
//     "scene": "four-bar", "set": ["l1"]
//     "hold": {"th1": "t1"}                coordinates that are given, each with a formula
//     "near": {"a2": "-1", "th3": "1.5"}   where assembly begins; left out: the mechanism is moved
//                                          from the start of the scene until "hold" holds
//     "time": 0.5, "method": "...", "second": "..."     instead of "hold": a motion
//     "asked": ["a2", "th3"]               coordinates of the answer, in this order
//     "within": 0.03                       [rad], or of the characteristic length
#include "grade/parts/blank.h"
#include "grade/parts/part_list.h"
#include "grade/parts/part_model.h"
#include "grade/parts/pose_solver.h"
#include "grade/parts/value_entry.h"

#include "base/units.h"
#include "dynamics/compile/coordinates.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX = HN_PART_ENTRIES, MAX_ASKED = HN_PART_RESULTS, MAX_TRIES = 40, MAX_STEPS = 200000 };
static const double PI = 3.14159265358979324;
static const double WITHIN = 0.03, STRIDE = 0.05;
static const double NEAR = 3; // times `within`: an answer so near is a matter of exactness
static const char OTHER_BRANCH[] = "other-branch", OTHER_TIME[] = "other-time";
static const double LARGEST_ANGLE = 1e6; // [rad] beyond, nobody means a direction

/// The mechanism, what is asked, and the configuration that is expected.
typedef struct sheet {
    const hn_part *p;
    hn_model *model;
    hn_pose_solver *solver;
    int n, n_asked, asked[MAX_ASKED];
    bool held[MAX];
    double expected[MAX];
    double absolute[MAX]; ///< angles from the axes of the ground, where the program uses such
    double within;
} sheet;

static const cJSON *field(const hn_part *p, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(p->node, name);
}

static hn_status fault_of(const sheet *s, hn_diag *diag, const char *pointer, const char *what) {
    return hn_diag_set(diag, HN_ERR_INPUT, pointer, NULL, "part %s: %s", s->p->id, what);
}

static bool is_angle(const sheet *s, int i) {
    return hn_part_coordinate(s->model, i)->kind == HN_ANGLE;
}

/// Returns how far two values of a coordinate are apart, in units of its reach; full turns do not
/// count.
static double apart(const sheet *s, int i, double a, double b) {
    return fabs(is_angle(s, i) ? remainder(a - b, 2 * PI) : a - b) /
           hn_pose_solver_reach(s->solver, i);
}

/// Values of an object {"th1": formula} in their places; `seen` (may be NULL) marks them.
static hn_status read_object(const sheet *s, const cJSON *object, double *x, bool *seen,
                             hn_diag *diag) {
    const cJSON *m;
    cJSON_ArrayForEach(m, object) {
        const int i = hn_part_find_coordinate(s->model, m->string, diag);
        const char *formula = cJSON_GetStringValue(m);
        if (i < 0 || !formula) {
            return i < 0 ? HN_ERR_INPUT : fault_of(s, diag, "/parts", "formulas are texts");
        }
        HN_TRY(hn_draw_value(s->p->draw, formula, &x[i], diag));
        if (seen) {
            seen[i] = true;
        }
    }
    return HN_OK;
}

/// Moves the held coordinates from the start to their values, loops closed all the way.
static hn_status move_there(sheet *s, const double *target, hn_diag *diag) {
    double start[MAX], x[MAX], far = 0;
    memcpy(start, hn_pose_solver_coordinates(s->solver), (size_t)s->n * sizeof *start);
    for (int i = 0; i < s->n; i++) {
        far = fmax(far, s->held[i] ? fabs(target[i] - start[i]) / hn_pose_solver_reach(s->solver, i)
                                   : 0);
    }
    const int steps = (int)fmin(ceil(far / STRIDE), 10000);
    for (int k = 1; k <= steps; k++) {
        memcpy(x, hn_pose_solver_coordinates(s->solver), (size_t)s->n * sizeof *x);
        for (int i = 0; i < s->n; i++) {
            x[i] = s->held[i] ? start[i] + (target[i] - start[i]) * k / steps : x[i];
        }
        hn_pose_solver_place(s->solver, x);
        if (hn_pose_solver_close(s->solver, s->held) != HN_OK) {
            return fault_of(s, diag, "/parts/hold",
                            "the mechanism cannot be moved from its start to \"hold\"");
        }
    }
    return HN_OK;
}

static hn_status assemble(sheet *s, hn_diag *diag) {
    double x[MAX];
    memcpy(x, hn_pose_solver_coordinates(s->solver), (size_t)s->n * sizeof *x);
    HN_TRY(read_object(s, field(s->p, "hold"), x, s->held, diag));
    const cJSON *near = field(s->p, "near");
    if (!near) {
        return move_there(s, x, diag);
    }
    HN_TRY(read_object(s, near, x, NULL, diag));
    hn_pose_solver_place(s->solver, x);
    return hn_pose_solver_close(s->solver, s->held) == HN_OK
               ? HN_OK
               : fault_of(s, diag, "/parts/near", "the loops cannot be closed near \"near\"");
}

/// Runs a method to the time of the part, and leaves the solver there.
static hn_status simulate(sheet *s, const char *method, hn_diag *diag) {
    hn_method_spec spec;
    hn_run *run = NULL;
    hn_sample sample;
    hn_run_opts opts = hn_run_opts_default();
    const double time = hn_part_number(s->p->node, "time", 0);
    opts.t_end = time;
    opts.max_steps = MAX_STEPS;
    HN_TRY(hn_method_parse(method, &spec, diag));
    hn_status status = hn_run_create(hn_model_system(s->model), &spec, hn_model_q(s->model),
                                     hn_model_v(s->model), &opts, &run, diag);
    HN_THEN(status, hn_part_advance(s->p, run, time));
    HN_THEN(status, hn_run_sample(run, time, &sample));
    if (status == HN_OK) {
        hn_pose_solver_place(s->solver, sample.q);
    } else if (status != HN_ERR_MEMORY && run) {
        fault_of(s, diag, "/parts/method", "the run ends early");
    }
    hn_run_free(run);
    return status == HN_OK || status == HN_ERR_MEMORY ? status : HN_ERR_INPUT;
}

static hn_status find_expected(sheet *s, const char *method, hn_diag *diag) {
    HN_TRY(method[0] ? simulate(s, method, diag) : assemble(s, diag));
    const hn_system *sys = hn_model_system(s->model);
    const hn_system_info info = hn_system_get_info(sys);
    memcpy(s->expected, hn_pose_solver_coordinates(s->solver), (size_t)s->n * sizeof(double));
    memcpy(s->absolute, s->expected, sizeof s->absolute);
    if (info.nq == info.n_user) {
        hn_system_from_user(sys, s->expected, s->absolute);
    }
    return HN_OK;
}

static hn_status open_sheet(sheet *s, const hn_part *p, hn_diag *diag) {
    const cJSON *m;
    s->p = p;
    s->within = hn_part_number(p->node, "within", WITHIN);
    HN_TRY(hn_part_load_model(p, &s->model, diag));
    HN_TRY(hn_pose_solver_create(s->model, &s->solver));
    s->n = hn_pose_solver_count(s->solver);
    if (s->n > MAX) {
        return fault_of(s, diag, "/parts/scene", "the scene has too many coordinates");
    }
    cJSON_ArrayForEach(m, field(p, "asked")) {
        const char *name = cJSON_GetStringValue(m);
        const int i = hn_part_find_coordinate(s->model, name ? name : "", diag);
        if (i < 0 || s->n_asked == MAX_ASKED) {
            return i < 0 ? HN_ERR_INPUT : fault_of(s, diag, "/parts/asked", "too many are asked");
        }
        s->asked[s->n_asked++] = i;
    }
    if (s->n_asked == 0) {
        return fault_of(s, diag, "/parts/asked", "no coordinate is asked for");
    }
    return find_expected(s, hn_part_text(p->node, "method"), diag);
}

static void close_sheet(sheet *s) {
    hn_pose_solver_free(s->solver);
    hn_model_free(s->model);
    free(s);
}

/// The sheet of a part, owned; NULL with the status.
static sheet *make_sheet(const hn_part *p, hn_status *status, hn_diag *diag) {
    sheet *s = calloc(1, sizeof *s);
    *status = s ? open_sheet(s, p, diag) : HN_ERR_MEMORY;
    if (s && *status != HN_OK) {
        close_sheet(s);
        s = NULL;
    }
    return s;
}

// ---- mistakes ----

/// The configuration that the loops close to from the answer; false: they do not close there.
static bool assemble_from(const sheet *s, const double *given, double *out) {
    double x[MAX];
    memcpy(x, s->expected, sizeof x);
    for (int k = 0; k < s->n_asked; k++) {
        x[s->asked[k]] = given[k];
    }
    hn_pose_solver_place(s->solver, x);
    const bool closed = hn_pose_solver_close(s->solver, s->held) == HN_OK;
    memcpy(out, hn_pose_solver_coordinates(s->solver), (size_t)s->n * sizeof *out);
    return closed;
}

/// The mistake of a whole answer in which the loops close, elsewhere than expected: another
/// assembly mode, or another time of a motion. NULL: it is none.
static const char *find_closed(const sheet *s, const double *given) {
    double other[MAX], moved = 0, differs = 0;
    if (!assemble_from(s, given, other)) {
        return NULL;
    }
    for (int k = 0; k < s->n_asked; k++) {
        const int i = s->asked[k];
        moved = fmax(moved, apart(s, i, given[k], other[i]));
        differs = fmax(differs, apart(s, i, other[i], s->expected[i]));
    }
    if (moved > s->within || differs <= 3 * s->within) {
        return NULL;
    }
    const bool moved_on =
        field(s->p, "time") && hn_pose_solver_same_modes(s->solver, other, s->expected);
    return moved_on ? OTHER_TIME : OTHER_BRANCH;
}

/// Another closed configuration with the same held coordinates; false: none was found.
static bool find_branch(const sheet *s, double *asked) {
    double other[MAX];
    for (int t = 0; t < MAX_TRIES; t++) {
        for (int k = 0; k < s->n_asked; k++) {
            const int i = s->asked[k];
            asked[k] =
                s->expected[i] + (2 * hn_draw_random(s->p->seed, (uint64_t)(t * 32 + k)) - 1) * PI *
                                     hn_pose_solver_reach(s->solver, i);
        }
        if (assemble_from(s, asked, other)) {
            for (int k = 0; k < s->n_asked; k++) {
                asked[k] = other[s->asked[k]];
            }
            if (find_closed(s, asked) == OTHER_BRANCH) {
                return true;
            }
        }
    }
    return false;
}

enum { DEGREES, SIGN, HALF_TURN, ABSOLUTE, INNER, RELATIVE, SWAPPED, N_SLIPS };
static const struct {
    const char *id, *says;
    double share;
} SLIPS[N_SLIPS] = {
    {"degrees", "this is the angle in degrees; radians are meant where no unit is written", 0.75},
    {"sign", "the angle has the other sign: angles are counted counter-clockwise", 0.25},
    {"half-turn", "the link points the other way: half a turn is missing", 0.25},
    {"absolute", "this is the angle from the x axis; this coordinate counts from the link before",
     0.5},
    {"inner", "this is pi less the angle: it was measured from the other side of the x axis", 0.25},
    {"relative", "this is an angle between two links; this coordinate is another angle", 0.25},
    {"swapped", "this is the value of another coordinate that is asked for", 0.25},
};

/// The value that a slip gives for the k-th coordinate asked for; `other` chooses among several.
/// NaN: the slip has none.
static double slip_value(const sheet *s, int slip, int k, int other) {
    const int i = s->asked[k];
    const double x = s->expected[i];
    const bool swaps = slip == SWAPPED, alone = slip != RELATIVE && !swaps;
    if ((alone && other > 0) || (other == i && !alone) || (!is_angle(s, i) && slip < SWAPPED)) {
        return (double)NAN;
    }
    if (swaps) {
        bool among = false;
        for (int j = 0; j < s->n_asked; j++) {
            among |= s->asked[j] == other;
        }
        return among ? s->expected[other] : (double)NAN;
    }
    const bool from_axis = fabs(s->absolute[i] - x) < 1e-9;
    const double values[] = {x * 180 / PI,
                             -x,
                             x + PI,
                             s->absolute[i],
                             from_axis ? PI - x : (double)NAN,
                             x - s->expected[is_angle(s, other) ? other : i]};
    return values[slip];
}

/// The first slip that gives a value; -1: none.
static int find_slip(const sheet *s, int k, double value) {
    for (int slip = 0; slip < N_SLIPS; slip++) {
        for (int other = 0; other < s->n; other++) {
            const double x = slip_value(s, slip, k, other);
            const double off = slip == DEGREES ? fabs(value - x) * PI / 180
                               : isfinite(x)   ? apart(s, s->asked[k], value, x)
                                               : HUGE_VAL;
            if (off <= s->within) {
                return slip;
            }
        }
    }
    return -1;
}

// ---- grading ----

static const char *unit_of(const sheet *s, int k) {
    return is_angle(s, s->asked[k]) ? "rad" : "m";
}

/// The entry of the k-th coordinate: by its name, or by its place in a list.
static const cJSON *entry_of(const sheet *s, const cJSON *given, int k) {
    return cJSON_IsArray(given)
               ? cJSON_GetArrayItem(given, k)
               : hn_part_member(given, hn_part_coordinate(s->model, s->asked[k])->name);
}

/// Reads all entries; results say which cannot be read. Returns whether all can.
static bool read_entries(const sheet *s, const cJSON *given, double *x, hn_part_result *results) {
    bool all = true;
    for (int k = 0; k < s->n_asked; k++) {
        hn_value_sheet reader = {.p = s->p, .draw = s->p->draw};
        hn_part_result *r = &results[k];
        double values[HN_DRAW_STATES];
        hn_ex e;
        *r = (hn_part_result){.mistake = ""};
        snprintf(r->name, sizeof r->name, "%.31s", hn_part_coordinate(s->model, s->asked[k])->name);
        snprintf(r->expected, sizeof r->expected, "%.4g %s", s->expected[s->asked[k]],
                 unit_of(s, k));
        hn_unit_parse(unit_of(s, k), &reader.unit);
        x[k] = (double)NAN;
        if (hn_value_entry_read(&reader, entry_of(s, given, k), values, &e, r)) {
            x[k] = values[0];
        }
        all &= isfinite(x[k]);
    }
    return all;
}

/// Returns how far the loops are open with the whole answer [m], which stays in the solver.
static double open_by(const sheet *s, const double *given) {
    double x[MAX];
    memcpy(x, s->expected, sizeof x);
    for (int k = 0; k < s->n_asked; k++) {
        x[s->asked[k]] = given[k];
    }
    hn_pose_solver_place(s->solver, x);
    return hn_pose_solver_open(s->solver);
}

/// Writes how far the loops are open with the whole answer, as a sentence behind another; "" where
/// closed.
static void say_open(const sheet *s, const double *given, char *text, size_t size) {
    const double gap = open_by(s, given);
    text[0] = 0;
    if (hn_pose_solver_gap(s->solver) > s->within) {
        snprintf(text, size, "; with the whole answer the loop is open by %.3g m", gap);
    }
}

/// Writes how well the loops close with an answer of the other branch: the picture shows what
/// rounded numbers leave open. "" where it is rounding.
static void say_closed(const sheet *s, const double *given, char *text, size_t size) {
    char gap[HN_SI_TEXT];
    const double open = open_by(s, given);
    text[0] = 0;
    if (open > 1e-9 * hn_system_length(hn_model_system(s->model))) {
        hn_si_format(open, "m", 2, gap);
        snprintf(text, size, " (your digits leave %s open)", gap);
    }
}

static void judge(const sheet *s, int k, const double *given, bool all, const char *closed,
                  hn_part_result *r) {
    const int i = s->asked[k];
    char open[100] = "";
    if (is_angle(s, i) && fabs(given[k]) > LARGEST_ANGLE) {
        hn_part_wrong(r, "other", 0,
                      "an angle of %.3g rad says no direction: after so many turns its last digits "
                      "are missing",
                      given[k]);
        return;
    }
    if (apart(s, i, given[k], s->expected[i]) <= s->within) {
        hn_part_right(r);
        return;
    }
    if (closed) {
        const bool time = closed == OTHER_TIME;
        say_closed(s, given, open, sizeof open);
        hn_part_wrong(r, closed, time ? 0.25 : 0.5, "the loop closes here too%s, but %s", open,
                      time ? "the links stand there at another time"
                           : "in the other assembly mode");
        return;
    }
    const int slip = find_slip(s, k, given[k]);
    if (all) {
        say_open(s, given, open, sizeof open);
    }
    if (slip >= 0) {
        // a guess comes as near as this to one of the slips about once in five times
        hn_part_wrong(r, SLIPS[slip].id, SLIPS[slip].share, "%s%s", SLIPS[slip].says, open);
        r->likely = slip != DEGREES || fabs(given[k]) < 2 * PI;
    } else {
        // the difference itself would give the right value away
        const bool near = apart(s, i, given[k], s->expected[i]) <= NEAR * s->within;
        hn_part_wrong(r, "other", 0, "%s%s", near ? "not exact enough" : "not this configuration",
                      open);
    }
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *results, int *n,
                       hn_diag *diag) {
    hn_status status;
    double x[MAX_ASKED];
    sheet *s = make_sheet(p, &status, diag);
    HN_TRY(status);
    if (!hn_part_begin(results, n, given, "")) {
        close_sheet(s);
        return HN_OK;
    }
    if (!cJSON_IsObject(given) && !cJSON_IsArray(given)) {
        hn_part_unreadable(results, "expected an object with the coordinates that are asked for");
        close_sheet(s);
        return HN_OK;
    }
    *n = s->n_asked;
    const bool all = read_entries(s, given, x, results);
    const char *closed = all ? find_closed(s, x) : NULL;
    for (int k = 0; k < s->n_asked; k++) {
        if (isfinite(x[k])) {
            judge(s, k, x, all, closed, &results[k]);
        }
    }
    hn_part_qualify(results, *n);
    close_sheet(s);
    return HN_OK;
}

static cJSON *write_answer(const sheet *s, const double *asked) {
    cJSON *out = cJSON_CreateObject();
    for (int k = 0; k < s->n_asked; k++) {
        cJSON_AddNumberToObject(out, hn_part_coordinate(s->model, s->asked[k])->name, asked[k]);
    }
    return out;
}

static void take_expected(const sheet *s, double *asked) {
    for (int k = 0; k < s->n_asked; k++) {
        asked[k] = s->expected[s->asked[k]];
    }
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    hn_status status;
    double asked[MAX_ASKED];
    sheet *s = make_sheet(p, &status, diag);
    if (!s) {
        return NULL;
    }
    take_expected(s, asked);
    cJSON *out = write_answer(s, asked);
    close_sheet(s);
    return out;
}

/// The i-th wrong answer: the other branch, then each slip in each coordinate. `id` is "" where a
/// slip gives a value that is right, or that of a slip before it.
static void make_fault(const sheet *s, int i, double *asked, const char **id) {
    if (i == 0) {
        *id = !field(s->p, "time") && find_branch(s, asked) ? OTHER_BRANCH : "";
        return;
    }
    const int slip = (i - 1) % N_SLIPS, k = (i - 1) / N_SLIPS;
    for (int other = 0; other < s->n; other++) {
        const double x = slip_value(s, slip, k, other);
        if (isfinite(x) && find_slip(s, k, x) == slip &&
            apart(s, s->asked[k], x, s->expected[s->asked[k]]) > s->within) {
            asked[k] = x;
            const char *closed = find_closed(s, asked);
            *id = closed ? closed : SLIPS[slip].id;
            return;
        }
    }
}

static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    hn_status status;
    double asked[MAX_ASKED];
    sheet *s = make_sheet(p, &status, diag);
    *id = "";
    if (!s || i > s->n_asked * N_SLIPS) {
        if (s) {
            close_sheet(s);
        }
        return NULL;
    }
    take_expected(s, asked);
    make_fault(s, i, asked, id);
    cJSON *out = write_answer(s, asked);
    close_sheet(s);
    return out;
}

/// By another method, or moved from the start of the scene: the same configuration.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    hn_status status;
    sheet *s = make_sheet(p, &status, diag);
    HN_TRY(status);
    const char *second = hn_part_text(p->node, "second");
    double first[MAX];
    memcpy(first, s->expected, sizeof first);
    if (field(p, "time")) {
        status = find_expected(s, second, diag);
    } else if (hn_pose_solver_gap(s->solver) > 1e-9) {
        status = fault_of(s, diag, "/parts/hold", "the configuration is not closed");
    }
    for (int i = 0; i < s->n && status == HN_OK; i++) {
        if (!(apart(s, i, first[i], s->expected[i]) <= s->within / 10)) {
            status = fault_of(s, diag, "/parts/second", "two methods do not agree at the end");
        }
    }
    close_sheet(s);
    return status;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    hn_status status;
    hn_diag diag = {0};
    sheet *s = make_sheet(p, &status, &diag);
    b->failed |= status == HN_ERR_MEMORY;
    if (!s) {
        return;
    }
    hn_strbuf_add(b, "{");
    for (int k = 0; k < s->n_asked; k++) {
        hn_strbuf_printf(b, "%s\"%s\": ...", k ? ", " : "",
                         hn_part_coordinate(s->model, s->asked[k])->name);
    }
    bool lengths = false;
    for (int k = 0; k < s->n_asked; k++) {
        lengths |= !is_angle(s, s->asked[k]);
    }
    hn_strbuf_printf(b, "} in rad%s, or with a unit: \"70 deg\"; right to %g rad",
                     lengths ? " and m" : "", s->within);
    if (lengths) {
        hn_strbuf_printf(b, " and %.3g m", s->within * hn_system_length(hn_model_system(s->model)));
    }
    hn_strbuf_printf(b, "; the scene is %s", hn_part_text(p->node, "scene"));
    hn_part_put_settings(b, p);
    close_sheet(s);
}

static void view(const hn_part *p, const cJSON *given, hn_part_view *out) {
    hn_status status;
    hn_diag diag = {0};
    double x[MAX_ASKED];
    hn_part_result results[HN_PART_RESULTS];
    sheet *s = make_sheet(p, &status, &diag);
    if (!s) {
        return;
    }
    if (read_entries(s, given, x, results) &&
        hn_part_settings(p, out->settings, &out->n_settings, &diag) == HN_OK) {
        out->scene = hn_part_text(p->node, "scene");
        out->overlay = true;
        out->n_entries = s->n;
        for (int i = 0; i < s->n; i++) {
            snprintf(out->names[i], sizeof out->names[i], "%.31s",
                     hn_part_coordinate(s->model, i)->name);
            out->given[i] = out->expected[i] = s->expected[i];
        }
        for (int k = 0; k < s->n_asked; k++) {
            out->given[s->asked[k]] = x[k];
        }
    }
    close_sheet(s);
}

const hn_part_kind hn_part_configuration = {
    .name = "configuration",
    .fields = "scene set hold near time method second asked within",
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_names,
    .right = right,
    .fault = fault,
    .prove = prove,
    .view = view,
};
