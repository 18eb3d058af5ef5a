// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/routes.h"

#include "http/live/comparisons.h"
#include "http/request/request.h"
#include "http/routes/catalogue.h"
#include "http/routes/exports.h"
#include "http/routes/openapi.h"
#include "http/routes/scene_files.h"
#include "http/routes/stateless.h"
#include "http/runs/run_stream.h"
#include "http/runs/runs.h"
#include "http/studies/studies.h"
#include "http/studies/study_fields.h"
#include "render/canvas.h"
#include "session/compare/comparison.h"
#include "session/model/run_time.h"

#include <stdio.h>
#include <string.h>

#define END_OF_FIELDS \
    { .name = NULL }
#define SCENE_FIELDS                                                                             \
    {.name = "scene",                                                                            \
     .type = HN_FIELD_SCENE,                                                                     \
     .required = 1,                                                                              \
     .about = "a shipped scene's id or a scene object"},                                         \
    {                                                                                            \
        .name = "parameters", .type = HN_FIELD_BY_NAME,                                          \
        .about = "parameters that differ from the scene's; start.NAME is where a coordinate or " \
                 "rate starts"                                                                   \
    }

enum { MAX_TIMES = 100000 };

static const char *const EQUATION_FORMATS[] = {"text", "latex", "json", NULL};
static const char *const STATES[] = {"running", "paused", NULL};

static const hn_field IMPORT[] = {
    {.name = "text", .type = HN_FIELD_TEXT, .required = 1, .about = "MJCF or URDF: XML"},
    {.name = "name",
     .type = HN_FIELD_TEXT,
     .about = "name of the scene; the model's own when left out"},
    {.name = "loops",
     .type = HN_FIELD_TEXT,
     .about = "the loop file: the joints that close loops, as JSON text"},
    END_OF_FIELDS};

static const hn_field SCENE_ONLY[] = {SCENE_FIELDS, END_OF_FIELDS};

/// A hand at a place that holds a point; entries of `pulls` say the same in numbers.
static const hn_field PULL[] = {
    {.name = "point",
     .type = HN_FIELD_INTEGER,
     .required = 1,
     .min = 0,
     .max = 1e6,
     .about = "index among the points of the scene"},
    {.name = "to",
     .type = HN_FIELD_NUMBERS,
     .required = 1,
     .min = 2,
     .max = 3,
     .about = "place of the hand in the world [m], [x, y] or [x, y, z]"},
    {.name = "stiffness",
     .type = HN_FIELD_NUMBER,
     .min = 0,
     .max = 1e12,
     .about = "stiffness of the hand's spring [N/m]; chosen from weight and size when left out"},
    {.name = "damping",
     .type = HN_FIELD_NUMBER,
     .min = 0,
     .max = 1e12,
     .about = "damping of the hand's spring [N s/m]; chosen when left out"},
    END_OF_FIELDS};
#define PULLS_FIELD                                                                               \
    {                                                                                             \
        .name = "pulls", .type = HN_FIELD_ANY,                                                    \
        .about = "pulls of the hand: a list of [frame, point, x, y, z, stiffness, damping]; the " \
                 "methods restart and repeat the pulls bit for bit"                               \
    }

static const hn_field TERMS[] = {
    SCENE_FIELDS,
    {.name = "t", .type = HN_FIELD_NUMBER, .about = "time [s]"},
    {.name = "state",
     .type = HN_FIELD_BY_NAME,
     .about = "coordinates and rates that differ from the assembled start"},
    {.name = "reactions",
     .type = HN_FIELD_BOOL,
     .about = "adds the reactions of every joint and constraint: forces [N], moments [N m], and "
              "efforts along coordinates. The reaction of a joint acts on its child, that of a "
              "distance on the body of 'to', that of a guide on the guided body"},
    {.name = "pull",
     .type = HN_FIELD_RECORD,
     .record = PULL,
     .about = "a spring by which a hand holds a point"},
    END_OF_FIELDS};

static const hn_field DRAG[] = {
    SCENE_FIELDS,
    {.name = "state",
     .type = HN_FIELD_BY_NAME,
     .about = "coordinates and rates from which the drag begins, where they differ from the "
              "assembled start: the state of the previous answer"},
    {.name = "point",
     .type = HN_FIELD_INTEGER,
     .min = 0,
     .max = 1e6,
     .about = "index among the points of the scene, unless a coordinate is given"},
    {.name = "coordinate",
     .type = HN_FIELD_TEXT,
     .about = "name of a coordinate, unless a point is given"},
    {.name = "target",
     .type = HN_FIELD_NUMBERS,
     .required = 1,
     .min = 1,
     .max = 3,
     .about =
         "for a point its place [x, y] or [x, y, z] in the world [m], for a coordinate its value"},
    END_OF_FIELDS};

static const hn_field EQUATIONS[] = {SCENE_FIELDS,
                                     {.name = "format",
                                      .type = HN_FIELD_CHOICE,
                                      .choices = EQUATION_FORMATS,
                                      .about = "text when left out"},
                                     END_OF_FIELDS};

static const hn_field EXPORT[] = {
    SCENE_FIELDS,
    {.name = "language", .type = HN_FIELD_TEXT, .about = "python when left out; see /languages"},
    {.name = "blanks",
     .type = HN_FIELD_BOOL,
     .about = "leaves the functions mass, force, jacobian and bias empty for students to fill in"},
    {.name = "method",
     .type = HN_FIELD_TEXT,
     .about = "index1@... or baumgarte:...@...: formulation of the program; another method is only "
              "named in the last line"},
    {.name = "style", .type = HN_FIELD_TEXT, .about = "skeleton: without self-check; or full"},
    {.name = "solver",
     .type = HN_FIELD_TEXT,
     .about = "name of a solver of the language; see /languages"},
    {.name = "format",
     .type = HN_FIELD_TEXT,
     .about = "mjcf or urdf: a model of the mechanism in place of a program; a comment at its end "
              "names the parts that it cannot hold"},
    END_OF_FIELDS};

static const hn_field RUN[] = {
    SCENE_FIELDS,
    {.name = "method",
     .type = HN_FIELD_TEXT,
     .is_method = true,
     .about = "FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...]"},
    {.name = "methods",
     .type = HN_FIELD_TEXTS,
     .is_method = true,
     .min = 1,
     .max = HN_COMPARISON_MAX_METHODS,
     .about = "several methods, in place of method"},
    {.name = "time",
     .type = HN_FIELD_NUMBER,
     .required = 1,
     .min = 1e-9,
     .max = HN_RUN_TIME_MAX,
     .about = "end of the run [s]"},
    {.name = "at",
     .type = HN_FIELD_NUMBERS,
     .min = 1,
     .max = MAX_TIMES,
     .about = "output times, ascending [s]"},
    {.name = "every",
     .type = HN_FIELD_NUMBER,
     .min = 1e-9,
     .max = HN_RUN_TIME_MAX,
     .about = "output interval [s]; 200 samples when neither is given"},
    {.name = "reactions",
     .type = HN_FIELD_BOOL,
     .about = "adds the columns reaction_force [N] and reaction_moment [N m], with three numbers "
              "for each entry of carriers, and effort, with one number for each entry of efforts"},
    {.name = "raw_lambda",
     .type = HN_FIELD_BOOL,
     .about = "a column raw_lambda too: the multipliers the scheme itself "
              "found, where it has some"},
    END_OF_FIELDS};

static const hn_field COMPARISON[] = {
    SCENE_FIELDS,
    {.name = "methods",
     .type = HN_FIELD_TEXTS,
     .is_method = true,
     .required = 1,
     .min = 1,
     .max = HN_COMPARISON_MAX_METHODS,
     .about = "a list of methods, as [\"projection@rk4:h=0.01\"]"},
    {.name = "frame_dt",
     .type = HN_FIELD_NUMBER,
     .min = 1e-6,
     .max = 10,
     .about = "time between frames [s]; chosen when left out"},
    {.name = "duration",
     .type = HN_FIELD_NUMBER,
     .min = 1e-6,
     .max = HN_RUN_TIME_MAX,
     .about = "end [s]; the scene's when left out"},
    {.name = "speed",
     .type = HN_FIELD_NUMBER,
     .min = 0.01,
     .max = 100,
     .about = "simulated seconds per second"},
    {.name = "paused", .type = HN_FIELD_BOOL, .about = "true when left out"},
    PULLS_FIELD,
    END_OF_FIELDS};

static const char *const THEMES[] = {"light", "dark", NULL};

static const hn_field SNAPSHOT[] = {
    SCENE_FIELDS,
    {.name = "methods",
     .type = HN_FIELD_TEXTS,
     .is_method = true,
     .required = 1,
     .min = 1,
     .max = HN_COMPARISON_MAX_METHODS,
     .about = "spellings of methods; the first is drawn opaque"},
    {.name = "time",
     .type = HN_FIELD_NUMBER,
     .required = 1,
     .min = 0,
     .max = HN_RUN_TIME_MAX,
     .about = "time of the picture [s]"},
    {.name = "width",
     .type = HN_FIELD_INTEGER,
     .min = HN_CANVAS_MIN,
     .max = HN_CANVAS_MAX,
     .about = "pixels"},
    {.name = "height",
     .type = HN_FIELD_INTEGER,
     .min = HN_CANVAS_MIN,
     .max = HN_CANVAS_MAX,
     .about = "pixels"},
    {.name = "theme", .type = HN_FIELD_CHOICE, .choices = THEMES, .about = "background"},
    {.name = "view",
     .type = HN_FIELD_TEXT,
     .about = "front, side, top, space, or azimuth and elevation in degrees: 35,22"},
    END_OF_FIELDS};

static const hn_field GRADE[] = {
    {.name = "problem", .type = HN_FIELD_TEXT, .required = 1, .about = "id of a problem"},
    {.name = "submission",
     .type = HN_FIELD_ANY,
     .required = 1,
     .about = "contents of the submission's file"},
    {.name = "seed",
     .type = HN_FIELD_INTEGER,
     .min = 0,
     .max = 9007199254740991.0,
     .about = "chooses the variant and the states at which answers are compared; 0: the variant "
              "that the submission names"},
    END_OF_FIELDS};

static const hn_field SET[] = {
    {.name = "method",
     .type = HN_FIELD_INTEGER,
     .min = -1,
     .max = HN_COMPARISON_MAX_METHODS - 1,
     .about = "index of the method; -1: all methods that have this option"},
    {.name = "key",
     .type = HN_FIELD_TEXT,
     .required = 1,
     .about = "name of an option, such as alpha"},
    {.name = "value", .type = HN_FIELD_NUMBER, .required = 1, .about = "the new value"},
    END_OF_FIELDS};

static const hn_field CHANGE[] = {
    {.name = "state", .type = HN_FIELD_CHOICE, .choices = STATES, .about = "play or pause"},
    {.name = "speed",
     .type = HN_FIELD_NUMBER,
     .min = 0.01,
     .max = 100,
     .about = "simulated seconds per second"},
    {.name = "step",
     .type = HN_FIELD_INTEGER,
     .min = 1,
     .max = 600,
     .about = "number of frames to advance while paused"},
    {.name = "reset", .type = HN_FIELD_BOOL, .about = "back to the start"},
    {.name = "methods",
     .type = HN_FIELD_TEXTS,
     .is_method = true,
     .min = 1,
     .max = HN_COMPARISON_MAX_METHODS,
     .about = "new methods; all methods restart"},
    {.name = "parameters",
     .type = HN_FIELD_BY_NAME,
     .about = "all parameters that differ from the scene's; all methods restart"},
    {.name = "set",
     .type = HN_FIELD_RECORD,
     .record = SET,
     .about = "changes an option of a formulation during the run"},
    {.name = "pull",
     .type = HN_FIELD_RECORD,
     .record = PULL,
     .about = "from the present frame on, a hand holds a point by a spring; the force acts in all "
              "methods, and its work counts in the energy change"},
    {.name = "release", .type = HN_FIELD_BOOL, .about = "the hand releases the point"},
    PULLS_FIELD,
    END_OF_FIELDS};

static const hn_route_query SCENE_QUERY[] = {{"set", "array", "parameter:value, may be repeated"},
                                             {NULL, NULL, NULL}};
static const hn_route_query REFERENCE_QUERY[] = {
    {"set", "array", "parameter:value, may be repeated"},
    {"time", "number", "end [s]; the end of the stored reference when left out"},
    {"every", "number", "adds the motion between the stored times, at this interval [s]"},
    {"compute", "boolean",
     "true: a reference that is not stored is computed, within run_cpu_s; otherwise the answer is "
     "404 with the reason"},
    {NULL, NULL, NULL}};
static const hn_route_query EXPORT_QUERY[] = {
    {"set", "array", "parameter:value, may be repeated"},
    {"language", "string", "python when left out; see /languages"},
    {"blanks", "boolean",
     "true: leaves the functions mass, force, jacobian and bias empty for students to fill in"},
    {"method", "string",
     "index1@... or baumgarte:...@...: formulation of the program; another method is only named in "
     "the last line"},
    {"style", "string", "skeleton: without self-check; or full"},
    {"solver", "string", "name of a solver of the language; see /languages"},
    {"format", "string",
     "mjcf or urdf: a model of the mechanism in place of a program; a comment at its end names the "
     "parts that it cannot hold"},
    {NULL, NULL, NULL}};
static const hn_route_query PROBLEM_QUERY[] = {
    {"hint", "integer",
     "number of a hint, from 1: the answer is this hint in place of the problem"},
    {NULL, NULL, NULL}};
static const hn_route_query RUN_QUERY[] = {
    {"wait", "number", "seconds to wait for the end, at most 60; POST: 25 when left out, GET: 0"},
    {NULL, NULL, NULL}};
static const hn_route_query RUN_EVENTS_QUERY[] = {
    {"mode", "string",
     "complete (every sample) or live (some 200 samples of each method, and every incident)"},
    {"last_event_id", "string", "the same as the Last-Event-ID header"},
    {"fields", "string", "columns of the samples, separated by commas: t,q,gap; all when left out"},
    {NULL, NULL, NULL}};
static const hn_route_query RUN_EXPORT_QUERY[] = {
    {"language", "string", "python when left out; see /languages"},
    {"method", "integer", "index of the method that the last line names; 0 when left out"},
    {NULL, NULL, NULL}};
static const hn_route_query PLACE_QUERY[] = {
    {"wait", "number", "seconds to wait while all places are taken, at most 60; 25 when left out"},
    {NULL, NULL, NULL}};
static const hn_route_query SAMPLES_QUERY[] = {
    {"fields", "string", "columns, separated by commas: t,q,gap; all when left out"},
    {"stride", "integer", "stride: one row for every so many samples"},
    {"from", "number", "first time [s]"},
    {"to", "number", "last time [s]"},
    {"cursor", "integer", "index of the first sample, from next_cursor or the Link header"},
    {"limit", "integer", "largest number of rows in a page, at most 100000"},
    {"method", "integer", "index of the method in a run by several; 0 when left out"},
    {NULL, NULL, NULL}};
static const hn_route_query EVENTS_QUERY[] = {
    {"mode", "string",
     "complete (every frame) or live (a slow reader skips frames, never incidents)"},
    {"last_event_id", "string", "the same as the Last-Event-ID header"},
    {"fields", "string",
     "further members of each frame, with an entry for each method: sigma_min, lambda, condition, "
     "separated by commas"},
    {NULL, NULL, NULL}};

#define JSON "application/json"

static const hn_route ROUTES[] = {
    {"GET", "/healthz", HN_WORK_LIGHT, hn_handle_health, NULL, JSON, "200", "Health",
     "Whether the server is up", NULL, NULL},
    {"GET", "/api/v1/healthz", HN_WORK_LIGHT, hn_handle_health, NULL, JSON, "200", "Health",
     "Whether the server is up", NULL, NULL},
    {"GET", "/api/v1/", HN_WORK_LIGHT, hn_handle_index, NULL, JSON, "200", "Index",
     "Links, version, limits, routes", NULL, NULL},
    {"GET", "/api/v1/openapi.json", HN_WORK_LIGHT, hn_handle_openapi, NULL, JSON, "200", "Document",
     "This description", NULL, NULL},
    {"GET", "/api/v1/scenes", HN_WORK_QUICK, hn_handle_scenes, NULL, JSON, "200", "Scenes",
     "Every shipped scene", NULL, NULL},
    {"GET", "/api/v1/scenes/{id}", HN_WORK_QUICK, hn_handle_scene, NULL, JSON, "200", "Scene",
     "One scene, assembled: what a page needs to draw it", SCENE_QUERY, NULL},
    {"GET", "/api/v1/scenes/{id}/document", HN_WORK_QUICK, hn_handle_scene_document, NULL, JSON,
     "200", "Document", "The file of a scene, as it was written", NULL, NULL},
    {"GET", "/api/v1/schema", HN_WORK_QUICK, hn_handle_scene_schema, NULL, JSON, "200", "Document",
     "The JSON schema of scene files", NULL, NULL},
    {"POST", "/api/v1/import", HN_WORK_HEAVY, hn_handle_import, IMPORT, JSON, "200", "Document",
     "Converts a model of another program (MJCF, URDF) to a scene, with notes on the parts that a "
     "scene cannot hold",
     NULL,
     "{\"text\":\"<robot name='arm'><link name='base'/><link name='arm'><inertial><mass "
     "value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
     "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/><axis xyz='0 0 "
     "1'/></joint></robot>\"}"},
    {"GET", "/api/v1/scenes/{id}/reference", HN_WORK_HEAVY, hn_handle_reference, NULL, JSON, "200",
     "Reference",
     "The reference solution of a scene, computed in two ways, with the digits on which they agree",
     REFERENCE_QUERY, NULL},
    {"GET", "/api/v1/scenes/{id}/export", HN_WORK_HEAVY, hn_handle_scene_export, NULL, "text/plain",
     "200", "Text", "A scene as a program that solves its equations and checks itself",
     EXPORT_QUERY, NULL},
    {"GET", "/api/v1/languages", HN_WORK_LIGHT, hn_handle_languages, NULL, JSON, "200", "Document",
     "Languages of export, with what a program in each needs", NULL, NULL},
    {"POST", "/api/v1/export", HN_WORK_HEAVY, hn_handle_export, EXPORT, "text/plain", "200", "Text",
     "Any scene as a program that solves its equations and checks itself", NULL,
     "{\"scene\":\"four-bar\",\"parameters\":{\"l1\":0.6},\"language\":\"octave\"}"},
    {"GET", "/api/v1/methods", HN_WORK_LIGHT, hn_handle_methods, NULL, JSON, "200", "Methods",
     "The catalogue of formulations and integrators", NULL, NULL},
    {"GET", "/api/v1/look", HN_WORK_LIGHT, hn_handle_look, NULL, JSON, "200", "Document",
     "Colours, dashes and markers of the method slots", NULL, NULL},
    {"GET", "/api/v1/lessons", HN_WORK_LIGHT, hn_handle_lessons, NULL, JSON, "200", "Lessons",
     "Lessons with their scenes and problems", NULL, NULL},
    {"GET", "/api/v1/lessons/{id}", HN_WORK_QUICK, hn_handle_lesson, NULL, JSON, "200", "Lesson",
     "A lesson by number or id, as a tree of blocks", NULL, NULL},
    {"GET", "/api/v1/lessons/{id}/pictures/{name}", HN_WORK_QUICK, hn_handle_lesson_picture, NULL,
     "image/png image/svg+xml", "200", "Picture", "A picture that a lesson shows", NULL, NULL},
    {"GET", "/api/v1/problems", HN_WORK_QUICK, hn_handle_problems, NULL, JSON, "200", "Problems",
     "Problems that can be graded", NULL, NULL},
    {"GET", "/api/v1/errors", HN_WORK_LIGHT, hn_handle_errors, NULL, JSON, "200", "Document",
     "The kinds of problem documents", NULL, NULL},
    {"GET", "/api/v1/errors/{code}", HN_WORK_LIGHT, hn_handle_error, NULL, JSON, "200", "Document",
     "What one kind of problem document means", NULL, NULL},
    {"POST", "/api/v1/terms", HN_WORK_HEAVY, hn_handle_terms, TERMS, JSON, "200", "Document",
     "M, f, J, gamma, K, accelerations and multipliers at one state", NULL,
     "{\"scene\":\"four-bar\",\"state\":{\"th1\":0.5},\"reactions\":true}"},
    {"POST", "/api/v1/assemble", HN_WORK_HEAVY, hn_handle_assemble, SCENE_ONLY, JSON, "200",
     "Document", "Consistent starting values", NULL,
     "{\"scene\":\"four-bar\",\"parameters\":{\"l1\":0.6}}"},
    {"POST", "/api/v1/drag", HN_WORK_QUICK, hn_handle_drag, DRAG, JSON, "200", "Drag",
     "The closed configuration that brings a point or a coordinate nearest to a target, within 50 "
     "ms of computing",
     NULL, "{\"scene\":\"four-bar\",\"coordinate\":\"th1\",\"target\":[1.2]}"},
    {"POST", "/api/v1/inspect", HN_WORK_HEAVY, hn_handle_inspect, SCENE_ONLY, JSON, "200",
     "Document", "Sizes, tree, loops, rank, and the operations of the compiled equations", NULL,
     "{\"scene\":\"four-bar\"}"},
    {"POST", "/api/v1/equations", HN_WORK_HEAVY, hn_handle_equations, EQUATIONS, JSON, "200",
     "Equations", "The equations of motion with parameters as symbols", NULL,
     "{\"scene\":\"four-bar\",\"format\":\"latex\"}"},
    {"GET", "/api/v1/runs", HN_WORK_HEAVY, hn_handle_runs_list, NULL, JSON, "200", "RunList",
     "Ids of the runs that are kept, and the number of damaged files", NULL, NULL},
    {"POST", "/api/v1/runs", HN_WORK_QUICK_OWN, hn_handle_runs_create, RUN, JSON, "201 200 202",
     "Run",
     "Runs a scene by one method or several; the same request has the same id and is computed once",
     RUN_QUERY,
     "{\"scene\":\"four-bar\",\"method\":\"projection@rk4:h=1e-3\",\"time\":1,\"every\":0.1}"},
    {"GET", "/api/v1/runs/{id}", HN_WORK_QUICK_OWN, hn_handle_run_get, NULL, JSON, "200", "Run",
     "State, progress and summary of a run; waits for its end when asked to", RUN_QUERY, NULL},
    {"GET", "/api/v1/runs/{id}/samples", HN_WORK_QUICK, hn_handle_run_samples, NULL,
     JSON " application/x-ndjson text/csv", "200", "Samples", "Rows of a run, a page at a time",
     SAMPLES_QUERY, NULL},
    {"GET", "/api/v1/runs/{id}/events", HN_WORK_QUICK, hn_handle_run_events, NULL,
     "text/event-stream", "200", "RunEvents",
     "Server-sent events of a run: progress, then each sample and incident, then the end",
     RUN_EVENTS_QUERY, NULL},
    {"GET", "/api/v1/runs/{id}/export", HN_WORK_HEAVY, hn_handle_run_export, NULL, "text/plain",
     "200", "Text", "The scene of a run, with its parameters, as a program that checks itself",
     RUN_EXPORT_QUERY, NULL},
    {"DELETE", "/api/v1/runs/{id}", HN_WORK_LIGHT, hn_handle_run_delete, NULL, JSON, "204", NULL,
     "Stops a run and deletes it; one that is already gone is no error", NULL, NULL},
    {"POST", "/api/v1/snapshots", HN_WORK_HEAVY, hn_handle_snapshot, SNAPSHOT, "image/png", "200",
     "Picture", "A picture of the scene after a run by the given methods", NULL,
     "{\"scene\":\"four-bar\",\"methods\":[\"projection@rk4:h=1e-3\"],\"time\":0.5}"},
    {"GET", "/api/v1/problems/{id}", HN_WORK_QUICK, hn_handle_problem, NULL, JSON, "200",
     "Document", "A problem's text and what to hand in; or one of its hints", PROBLEM_QUERY, NULL},
    {"POST", "/api/v1/grade", HN_WORK_HEAVY, hn_handle_grade, GRADE, JSON, "200", "Verdict",
     "Grades one submission", NULL,
     "{\"problem\":\"p3\",\"submission\":{\"J\":[[\"-l1*sin(th1)\",\"-l2*sin(th2)\",\"l3*sin(th3)"
     "\",\"l4*sin(th4)\"],[\"l1*cos(th1)\",\"l2*cos(th2)\",\"-l3*cos(th3)\",\"-l4*cos(th4)\"]]}}"},
    {"GET", "/api/v1/comparisons", HN_WORK_LIGHT, hn_handle_comparisons_list, NULL, JSON, "200",
     "ComparisonList", "Ids of all comparisons", NULL, NULL},
    {"POST", "/api/v1/comparisons", HN_WORK_QUICK_OWN, hn_handle_comparisons_create, COMPARISON,
     JSON, "201", "Comparison", "Makes a comparison", PLACE_QUERY,
     "{\"scene\":\"four-bar\",\"methods\":[\"index1@rk4:h=1e-2\",\"projection@rk4:h=1e-2\"]}"},
    {"GET", "/api/v1/comparisons/{id}", HN_WORK_LIGHT, hn_handle_comparison_get, NULL, JSON, "200",
     "Comparison", "A comparison and its latest frame", NULL, NULL},
    {"PATCH", "/api/v1/comparisons/{id}", HN_WORK_OWN, hn_handle_comparison_patch, CHANGE, JSON,
     "200", "Comparison",
     "Plays, pauses, steps or resets a comparison, or changes its speed, methods and options", NULL,
     "{\"state\":\"paused\",\"step\":10}"},
    {"DELETE", "/api/v1/comparisons/{id}", HN_WORK_LIGHT, hn_handle_comparison_delete, NULL, JSON,
     "204", NULL, "Ends a comparison; one that is already gone is no error", NULL, NULL},
    {"GET", "/api/v1/comparisons/{id}/pulls", HN_WORK_LIGHT, hn_handle_comparison_pulls, NULL, JSON,
     "200", "Document", "The pulls of the hand so far, in the form that POST and PATCH take", NULL,
     NULL},
    {"GET", "/api/v1/comparisons/{id}/events", HN_WORK_LIGHT, hn_handle_comparison_events, NULL,
     "text/event-stream", "200", "Events", "Server-sent events: one stream for all methods",
     EVENTS_QUERY, NULL},
    {"GET", "/api/v1/studies", HN_WORK_LIGHT, hn_handle_studies_list, NULL, JSON, "200",
     "StudyList", "All studies", NULL, NULL},
    {"POST", "/api/v1/studies", HN_WORK_HEAVY_OWN, hn_handle_studies_create, hn_study_fields, JSON,
     "202", "Study",
     "Starts a study; the address in its Location header gives the progress, and in the end the "
     "document",
     PLACE_QUERY,
     "{\"scene\":\"four-bar\",\"kind\":\"work-precision\",\"methods\":[\"projection@rk4\",\"index1@"
     "rk4\"],\"time\":1,\"levels\":3,\"samples\":0}"},
    {"GET", "/api/v1/studies/{id}", HN_WORK_LIGHT, hn_handle_study_get, NULL, JSON, "200", "Study",
     "State, progress, time left, and the document when it is done", NULL, NULL},
    {"GET", "/api/v1/studies/{id}/report", HN_WORK_LIGHT, hn_handle_study_report, NULL, "text/html",
     "200", "Report", "The study as one HTML file that needs no network", NULL, NULL},
    {"PATCH", "/api/v1/studies/{id}", HN_WORK_QUICK_OWN, hn_handle_study_patch, hn_study_change,
     JSON, "200", "Study",
     "Stops a study and keeps its results, or continues a stopped one when there is a place for it",
     PLACE_QUERY, "{\"state\":\"stopped\"}"},
    {"DELETE", "/api/v1/studies/{id}", HN_WORK_LIGHT, hn_handle_study_delete, NULL, JSON, "204",
     NULL, "Stops a study and deletes it; one that is already gone is no error", NULL, NULL},
};
enum { N_ROUTES = sizeof ROUTES / sizeof *ROUTES };

hn_route_table hn_routes(void) {
    return (hn_route_table){.row = ROUTES, .n = N_ROUTES};
}
