// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_JOB_REQUEST_H
#define HN_SESSION_JOB_REQUEST_H
// The request of a long job: the scenes, the methods, the values of its own fields (field.h), and
// its limits. All kinds of jobs share this one request; session/kinds/job.h lists the kinds.

#include "integrators/method/method_spec.h"
#include "session/job/field.h"
#include "session/model/model.h"

enum { HN_JOB_METHODS = 24, HN_JOB_SCENES = 12, HN_JOB_VALUES = 8 };

/// The limits of a job, the folder for unfinished work, and the callbacks for stop and progress.
typedef struct hn_job_limits {
    double time_limit;       ///< wall time [s]; NaN: the kind's own default; 0: none
    int threads;             ///< that may work at once, where a kind can use them; 0: one
    const char *folder;      ///< for references and unfinished work; NULL: nothing is kept
    int (*stop)(void *user); ///< asked now and then; 1: stop, what is done is kept; NULL: never
    /// The share of the whole that is done, 0 to 1. `part`: what is worked at, as a scene's id; ""
    /// where a job has no parts. May be NULL.
    void (*progress)(void *user, const char *part, double share);
    void *user;
} hn_job_limits;

/// A preset of a job, chosen by name.
typedef struct hn_job_preset {
    const char *name, *about;
    const char *chooses; ///< options of methods that the job sets itself, separated by blanks
    bool stabilised;     ///< of formulations that have alpha and beta
    const char *units;   ///< of a parameter that the scene must have, separated by blanks; "": none
} hn_job_preset;

/// The value of one field of a kind: a number, or a text.
typedef struct hn_job_value {
    const char *name;
    double number;
    const char *text; ///< NULL: `number` counts
} hn_job_value;

/// Returns owned in *out a model of the request's scene with these parameters on top.
typedef hn_status (*hn_job_load)(void *user, const hn_setting *parameters, int n, hn_model **out,
                                 hn_diags *diags);

/// Start from hn_job_request_default(). Everything it points to is borrowed and must outlive the
/// job.
typedef struct hn_job_request {
    const hn_library *lib; ///< for kinds that load scenes by name
    const hn_model *models[HN_JOB_SCENES];
    int n_models;
    const char *methods[HN_JOB_METHODS]; ///< spellings
    int n_methods;                       ///< 0: the kind's own choice
    const char *const *ids;              ///< names of cases, for kinds that have no scene
    int n_ids;
    double time; ///< end of the motion [s]; NaN: the scene's
    hn_job_value values[HN_JOB_VALUES];
    int n_values;
    hn_job_load load; ///< for kinds that change parameters
    void *load_user;
    const char *build; ///< what the program calls itself, for documents; NULL: not said
    bool keep;         ///< what is kept of a finished job stays too, until its owner deletes it
    hn_job_limits limits;
} hn_job_request;

/// Returns a request for one model (NULL: none) with nothing else set.
hn_job_request hn_job_request_default(const hn_model *model);
/// Sets the methods. Fails: HN_ERR_LIMIT, reported in diags: more than HN_JOB_METHODS.
HN_MUST_CHECK hn_status hn_job_request_set_methods(hn_job_request *request,
                                                   const char *const *methods, int n,
                                                   hn_diags *diags);
/// Sets the value of a field; at most HN_JOB_VALUES of them.
void hn_job_request_set(hn_job_request *request, const char *name, double number);
void hn_job_request_set_text(hn_job_request *request, const char *name, const char *text);
/// Takes "methods", "time", "time_limit" and the values of all other fields from an object that
/// hn_fields_check() has passed. Texts are borrowed from it. Fails: HN_ERR_LIMIT (methods).
HN_MUST_CHECK hn_status hn_job_request_read(hn_job_request *request, const cJSON *object,
                                            const hn_field *fields, hn_diags *diags);

/// The value of a field; `otherwise` where the request has none.
double hn_job_number(const hn_job_request *request, const char *name, double otherwise);
const char *hn_job_text(const hn_job_request *request, const char *name); ///< NULL: none

/// Fills in what the request leaves open and checks it: the end time (the scene's), the time limit,
/// the spellings of the methods.
///
/// time_limit  in   [s] the kind's own, where the request has none
/// most        in   methods that the kind takes, at most HN_JOB_METHODS
/// specs       out  (n_methods) the methods
/// Fails: HN_ERR_INPUT (a time, a spelling), HN_ERR_LIMIT (too many methods); reported in diags
/// with
///        the pointers /time, /time_limit, /methods and /methods/I.
HN_MUST_CHECK hn_status hn_job_complete(hn_job_request *request, double time_limit, int most,
                                        hn_method_spec *specs, hn_diags *diags);

/// Asks the limits whether to stop.
bool hn_job_must_stop(const hn_job_limits *limits);
/// Reports a share of the whole.
void hn_job_progress(const hn_job_limits *limits, const char *part, double share);
#endif
