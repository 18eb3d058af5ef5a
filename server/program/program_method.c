// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/program_method.h"

#include "dynamics/compile/coordinates.h"
#include "formulations/ground/state_ode.h"
#include "integrators/method/guest.h"
#include "program/conversation.h"
#include "program/sandbox.h"

#include <dirent.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PROGRAMS = 32, NAME = 220 };

/// One program file and its method. Stays for the life of the process.
typedef struct program {
    char name[NAME]; ///< "program:./mine.py"
    char file[1024];
    hn_formulation formulation;
    // what its processes used
    long long answers, peak;
    double cpu;
} program;

static hn_program_opts options;

static hn_program_limits get_limits(void) {
    hn_program_limits limits = hn_program_limits_default();
    if (options.answer > 0) {
        hn_program_limits_set_answer(&limits, options.answer);
    }
    return limits;
}

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; // of the list below
static program *programs[MOST_PROGRAMS];
static int n_programs;

/// A process, and how many instances ask it.
typedef struct shared_talk {
    hn_conversation talk;
    const hn_arena *run; ///< of the instances: they live in the memory of one run
    const program *program;
    int users;
    struct shared_talk *next;
} shared_talk;

/// An instance. A run has two: one that steps, and one for samples between its steps.
typedef struct guest {
    hn_state_ode base; // first
    program *program;
    shared_talk *own;
    hn_conversation *talk; ///< of `own`
} guest;

static shared_talk *talks; // under the lock

static void keep_why(guest *g) {
    snprintf(g->base.why, sizeof g->base.why, "%.230s", g->talk->why.message);
}

// ---- the formulation ----

/// The process of this run, for another instance: NULL where there is none yet, or where it makes
/// steps of its own, which another one must not disturb.
static shared_talk *find_talk(const program *p, const hn_arena *run) {
    pthread_mutex_lock(&lock);
    shared_talk *found = talks;
    while (found && (found->run != run || found->program != p ||
                     found->talk.service != HN_PROGRAM_ACCELERATIONS)) {
        found = found->next;
    }
    if (found) {
        found->users++;
    }
    pthread_mutex_unlock(&lock);
    return found;
}

static void keep_talk(shared_talk *talk) {
    pthread_mutex_lock(&lock);
    talk->next = talks;
    talks = talk;
    pthread_mutex_unlock(&lock);
}

/// Returns whether the last instance has left; the process is then no longer found.
static bool leave_talk(shared_talk *talk) {
    pthread_mutex_lock(&lock);
    const bool is_last = --talk->users == 0;
    shared_talk **at = &talks;
    while (is_last && *at && *at != talk) {
        at = &(*at)->next;
    }
    if (is_last && *at) {
        *at = talk->next;
    }
    pthread_mutex_unlock(&lock);
    return is_last;
}

static hn_status create(const hn_system *sys, const double *set, hn_arena *arena, void **self,
                        hn_diag *diag) {
    const hn_program_limits limits = get_limits();
    hn_sandbox_command command;
    guest *g = hn_arena_get(arena, sizeof *g);
    if (!g) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *g = (guest){.program = programs[(int)set[0]]};
    *self = g;
    HN_TRY(hn_state_ode_init(&g->base, sys, arena));
    HN_TRY(hn_sandbox_build(&command, g->program->file, NULL, options.trusted, &limits, diag));

    // one process for both instances of a run: an interpreter takes its time to start
    g->own = find_talk(g->program, arena);
    if (!g->own) {
        g->own = hn_arena_get(arena, sizeof *g->own);
        if (!g->own) {
            return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
        }
        *g->own = (shared_talk){.run = arena, .program = g->program, .users = 1};
        g->talk = &g->own->talk;
        const hn_status status = hn_conversation_begin(
            g->talk, sys, command.argv, command.file[0] ? command.file : NULL, &limits, arena);
        keep_talk(g->own);
        return status;
    }
    g->talk = &g->own->talk;
    return HN_OK;
}

static hn_status check(const void *self, const char *integrator, hn_diag *diag) {
    const guest *g = self;
    return hn_conversation_check(g->talk, strcmp(integrator, HN_GUEST_STEPPER) == 0, diag);
}

static void destroy(void *self) {
    guest *g = self;
    if (g->own && leave_talk(g->own)) {
        hn_conversation_end(g->talk);
        pthread_mutex_lock(&lock);
        g->program->answers += g->talk->id;
        g->program->cpu += g->talk->process.cpu;
        g->program->peak =
            g->talk->process.peak > g->program->peak ? g->talk->process.peak : g->program->peak;
        pthread_mutex_unlock(&lock);
    }
    hn_state_ode_destroy(&g->base);
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    guest *g = self;
    const double *q = hn_unit_positions(g->base.sys, y, g->base.unit), *v = y + g->base.nq;
    g->base.cost.evals++;
    const double before = g->talk->cpu;
    const hn_status status = hn_conversation_accelerations(g->talk, t, q, v, ydot + g->base.nq);
    g->base.cost.elsewhere += g->talk->cpu - before;
    if (status != HN_OK) {
        keep_why(g);
        return status;
    }
    hn_system_kinematics(g->base.sys, y, v, ydot);
    return HN_OK;
}

static void get_ode(void *self, hn_ode *out) {
    hn_state_ode_get(self, rhs, out);
    // only the program knows its derivatives: implicit integrators take differences
    out->jacobian = NULL;
    out->newton = NULL;
    out->prepare = NULL;
}

static const hn_formulation FORMULATION = {
    .short_name = "your program",
    .rule = "A program of your own computes the accelerations, or makes the steps; the workbench "
            "measures what comes out.",
    .drift = "as the program's own equations say",
    .when = "to see your own solver beside the others",
    .when_not = "where time is measured: every answer crosses a pipe",
    .source = "its author",
    .needs = "what its greeting asks for",
    .index = 1,
    .n_options = 1,
    .create = create,
    .destroy = destroy,
    .ode = get_ode,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .add_cost = hn_state_ode_add_cost,
    .why = hn_state_ode_why,
    .check = check,
};

// ---- the integrator of programs that make their own steps ----

static void *create_stepper(int n_pos, int n_vel, hn_arena *arena) {
    (void)n_pos;
    (void)n_vel;
    return hn_arena_get(arena, sizeof(double));
}

static hn_status step(void *self, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err) {
    guest *g = ode->self;
    (void)self;
    (void)err;
    g->base.cost.evals++;
    const double before = g->talk->cpu;
    const hn_status status =
        hn_conversation_step(g->talk, t, h, y, y + g->base.nq, y_new, y_new + g->base.nq);
    g->base.cost.elsewhere += g->talk->cpu - before;
    if (status != HN_OK) {
        keep_why(g);
    }
    return status;
}

static void on_accepted(void *self, int changed) {
    (void)self;
    (void)changed;
}

static const hn_stepper STEPPER = {
    .name = HN_GUEST_STEPPER,
    .title = "its own steps",
    .about = "The program makes the steps; the workbench asks for the state at each.",
    .source = "its author",
    .order = 0, // nobody has said what it is
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {{.key = "h",
                 .initial = 1e-3,
                 .min = 1e-12,
                 .max = 100,
                 .unit = "s",
                 .about = "step size"}},
    .create = create_stepper,
    .step = step,
    .on_accepted = on_accepted,
};

// ---- names ----

/// In a server a message names a program as its reader does: without the folder, which is nobody's
/// business.
static void hide_folder(hn_diag *diag) {
    const size_t n = options.folder ? strlen(options.folder) : 0;
    char *const at = n > 0 && diag ? strstr(diag->message, options.folder) : NULL;
    if (at) {
        const size_t more = at[n] == '/';
        memmove(at, at + n + more, strlen(at + n + more) + 1);
    }
}

/// Returns whether a file is in the folder or below it once links are followed. One that is not
/// there is refused later, with its reason.
static bool is_inside(const char *file, const char *folder) {
    char *target = realpath(file, NULL), *home = realpath(folder, NULL);
    const size_t n = home ? strlen(home) : 0;
    const bool inside = !target || (home && strncmp(target, home, n) == 0 &&
                                    (target[n] == '/' || (n > 0 && home[n - 1] == '/')));
    free(target);
    free(home);
    return inside;
}

/// The file of a name; in a folder of the server a name is no path.
static hn_status find_file(const char *name, char file[1024], hn_diag *diag) {
    if (!options.folder) {
        snprintf(file, 1024, "%s", name);
        return HN_OK;
    }
    if (!name[0] || name[0] == '.' || strchr(name, '/')) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                           "name a file of the folder that serve was "
                           "given with --programs",
                           "'%.100s' is no name of a program here", name);
    }
    snprintf(file, 1024, "%.700s/%.300s", options.folder, name);
    return is_inside(file, options.folder)
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_INPUT, NULL,
                             "put the program itself into the folder that serve was given with "
                             "--programs",
                             "'%.100s' is a link to a file outside of it", name);
}

/// The entry of a program, made when it is first asked for. Under the lock.
static program *find_program(const char *name, const char *file) {
    for (int i = 0; i < n_programs; i++) {
        if (strcmp(programs[i]->name, name) == 0) {
            return programs[i];
        }
    }

    // a new entry
    program *p = n_programs < MOST_PROGRAMS ? calloc(1, sizeof *p) : NULL;
    if (!p) {
        return NULL;
    }
    snprintf(p->name, sizeof p->name, "%s", name);
    snprintf(p->file, sizeof p->file, "%s", file);
    p->formulation = FORMULATION;
    p->formulation.name = p->name;
    p->formulation.title = p->name;
    const char *slash = strrchr(p->name, '/');
    p->formulation.short_name = slash ? slash + 1 : p->name + strlen(HN_GUEST_PREFIX);
    // the option that tells create() which program it is; it has this value alone, so that no
    // spelling shows it
    p->formulation.options[0] = (hn_option){.key = "number",
                                            .initial = n_programs,
                                            .min = n_programs,
                                            .max = n_programs,
                                            .about = "which program"};
    programs[n_programs++] = p;
    return p;
}

static hn_status find(const char *name, hn_guest *out, hn_diag *diag) {
    char file[1024];
    hn_sandbox_command command;
    const hn_program_limits limits = get_limits();
    if (strlen(name) >= NAME) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the name of the program is too long");
    }
    HN_TRY(find_file(name + strlen(HN_GUEST_PREFIX), file, diag));
    const hn_status status = hn_sandbox_build(&command, file, NULL, options.trusted, &limits, diag);
    if (status != HN_OK) {
        hide_folder(diag);
        return status;
    }
    pthread_mutex_lock(&lock);
    program *p = find_program(name, file);
    pthread_mutex_unlock(&lock);
    if (!p) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "there are %d programs already",
                           MOST_PROGRAMS);
    }
    *out = (hn_guest){&p->formulation, &STEPPER};
    return HN_OK;
}

/// The programs of the server's folder by name; none where any path may be given.
static void list(hn_strbuf *b) {
    struct dirent **entries = NULL;
    const int n = options.folder ? scandir(options.folder, &entries, NULL, alphasort) : 0;
    for (int i = 0; i < n; i++) {
        char file[1024], name[NAME];
        hn_diag diag = {0};
        if (find_file(entries[i]->d_name, file, &diag) == HN_OK &&
            hn_sandbox_can_start(file, options.trusted) &&
            snprintf(name, sizeof name, "%s%s", HN_GUEST_PREFIX, entries[i]->d_name) < NAME) {
            hn_json_string(b, name);
        }
        free(entries[i]);
    }
    free(entries);
}

void hn_programs_allow(const hn_program_opts *opts) {
    options = *opts;
    hn_guest_serve(find, list);
}

void hn_programs_report(void) {
    pthread_mutex_lock(&lock);
    for (int i = 0; i < n_programs; i++) {
        const program *p = programs[i];
        if (p->answers > 0) {
            fprintf(
                stderr,
                "holonom: %s was asked %lld times and took %.2f s of computing time of its own%s",
                p->name, p->answers, p->cpu, p->peak > 0 ? "" : "\n");
        }
        if (p->answers > 0 && p->peak > 0) {
            fprintf(stderr, ", with at most %lld MB\n", p->peak >> 20);
        }
    }
    pthread_mutex_unlock(&lock);
}
