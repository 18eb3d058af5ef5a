// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_JOB_H
#define HN_SESSION_JOB_H
// The registry of long jobs: they take seconds to minutes, keep unfinished work, and produce
// documents. A kind is one file (kind_NAME.c) and one row of the list in job.c. The command line,
// the server and, through the index of the API, the page read what they need from the row.

#include "session/job/job_request.h"
#include "session/model/run_time.h"

enum { HN_JOB_FORMS = 6 };

/// A document that a job can be written as.
typedef struct hn_job_form {
    const char *suffix; ///< of a file: ".html"; NULL behind the last
    void (*put)(hn_strbuf *b, const void *work);
} hn_job_form;
/// Defines put_NAME(b, work), a writer of `type` as a form.
#define HN_JOB_FORM(name, type, writer)                      \
    static void put_##name(hn_strbuf *b, const void *work) { \
        writer(b, (const type *)work);                       \
    }

/// Outcome of the run of a job; all false: complete.
typedef struct hn_job_end {
    bool stopped;     ///< on request
    bool out_of_time; ///< the time limit left something out
    bool differs;     ///< it is complete, and a result differs from its prediction
    bool lost;        ///< what is done could not be written into the journal: it is not kept
} hn_job_end;

/// The meaning of the words after the command, on the command line.
typedef enum hn_job_words {
    HN_JOB_WORDS_SCENES, ///< scenes; none: those of the standard report
    HN_JOB_WORDS_SCENE,  ///< one scene, and the kind's name
    HN_JOB_WORDS_IDS     ///< names that the kind knows itself
} hn_job_words;

typedef struct hn_job_kind {
    const char *name;       ///< "work-precision"
    const char *title;      ///< "what accuracy costs", for a tab of the page; of served kinds
    const char *about;      ///< one clause
    const char *command;    ///< of the command line
    hn_job_words words;     ///< of the command line
    const char *pieces;     ///< what of an unfinished job is kept: "points"
    const char *chooses;    ///< options of methods that it sets itself, separated by blanks
    bool served;            ///< offered by the server
    bool opens_slowly;      ///< open() computes for seconds
    const hn_field *fields; ///< beside the scene
    const hn_job_preset *(*preset)(int i); ///< choices of its field "preset"; NULL: none
    /// Appends what the parts of its numbers are called, by the member of the document that has
    /// them: {"error": [{"name","letter","word","about"}...]}. NULL: its numbers have no parts.
    void (*put_parts)(hn_strbuf *b);
    hn_job_form forms[HN_JOB_FORMS];
    /// Checks the request and takes up what an interrupted job of the same request left. Returns
    /// owned in *work. Fails: HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_IO and others, reported in diags.
    hn_status (*open)(const hn_job_request *request, void **work, hn_diags *diags);
    int (*resumed)(const void *work); ///< pieces taken up; NULL: none ever
    /// Computes the remaining pieces. Fails: reported in diags; there is then no document.
    hn_status (*run)(void *work, const hn_job_request *request, hn_job_end *end, hn_diags *diags);
    /// Sets the wall time of each later run [s]. A kind that has it may be run again and goes on.
    /// NULL: a run is the only one.
    void (*set_time_limit)(void *work, double time_limit);
    void (*release)(void *work);
    /// Appends what the file that --out names holds, whatever its ending. NULL: the ending chooses
    /// a form.
    void (*save)(hn_strbuf *b, const void *work);
} hn_job_kind;

/// Returns kind i of the registry; NULL beyond the last.
const hn_job_kind *hn_job_kind_at(int i);
/// Returns the kind of this name; NULL: there is none.
const hn_job_kind *hn_job_kind_find(const char *name);

/// Checks an object against the fields of a kind (hn_fields_check()). A member that another kind
/// takes is reported with both names. Fails: HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_job_check(const hn_job_kind *kind, const cJSON *object, bool served,
                                     hn_diags *diags);

typedef struct hn_job hn_job;
/// Opens a job. The request is copied; what it points to must outlive the job. Returns owned in
/// *out. Fails: as the kind's open(), HN_ERR_MEMORY, HN_ERR_STOPPED (it was stopped before there
/// was a job; it may be opened again).
HN_MUST_CHECK hn_status hn_job_open(const hn_job_kind *kind, const hn_job_request *request,
                                    hn_job **out, hn_diags *diags);
int hn_job_resumed(const hn_job *job);
/// Computes what is left. If the kind has set_time_limit() it may be called again after an end
/// that left something out: then it goes on, with the whole time limit. Fails: as the kind's run().
HN_MUST_CHECK hn_status hn_job_run(hn_job *job, hn_job_end *end, hn_diags *diags);
/// Sets the wall time of each later run [s]. The kind must have set_time_limit().
void hn_job_set_time_limit(hn_job *job, double time_limit);
/// Writes the form of this suffix (".json"). Returns false when the kind has none.
bool hn_job_write(hn_strbuf *b, const hn_job *job, const char *suffix);
const void *hn_job_work(const hn_job *job); ///< what the kind's forms write
void hn_job_free(hn_job *job);              ///< NULL is legal

/// The list for the index of the API:
/// [{"name","title","about","chooses","fields":[{"name","type","min","max","choices","about"}...],
/// "presets":[{"name","about","chooses","stabilised","units"}...],"parts"}...], kinds that a server
/// offers, with "parts" where the kind has put_parts(), and bounds as they hold there.
/// `time_limit`: the server's own field of that name, in place of each kind's.
void hn_job_kinds_json(hn_strbuf *b, const hn_field *time_limit);

// fields that several kinds have
#define HN_JOB_METHODS_FIELD(most, served)                                                         \
    {                                                                                              \
        .name = "methods", .type = HN_FIELD_TEXTS, .min = 1, .max = (most),                        \
        .served_max = (served), .about = "spellings of methods; a choice of methods when left out" \
    }
#define HN_JOB_TIME_FIELD                                                             \
    {                                                                                 \
        .name = "time", .type = HN_FIELD_NUMBER, .min = 1e-9, .max = HN_RUN_TIME_MAX, \
        .about = "end of the motion [s]; the scene's when left out"                   \
    }
#define HN_JOB_TIME_LIMIT_FIELD(default_words)                                                   \
    {                                                                                            \
        .name = "time_limit", .type = HN_FIELD_NUMBER, .min = 0, .max = 1e9, .served_max = 3600, \
        .argument = "S", .about = "wall time of the computation [s]; " default_words             \
    }
#define HN_JOB_LEVELS_FIELD                                                        \
    {                                                                              \
        .name = "levels", .type = HN_FIELD_INTEGER, .min = 2, .max = HN_WP_LEVELS, \
        .served_max = 7, .argument = "N",                                          \
        .about = "steps or tolerances per method; 7 when left out"                 \
    }
#define HN_JOB_SAMPLES_FIELD                                                                \
    {                                                                                       \
        .name = "samples", .type = HN_FIELD_INTEGER, .max = HN_WP_SAMPLES, .argument = "N", \
        .about = "time samples per point; 10 when left out, 0: operation counts only"       \
    }
#define HN_JOB_END_OF_FIELDS \
    { .name = NULL }
#endif
