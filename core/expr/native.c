// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/native.h"

#include "base/clock.h"
#include "base/hash.h"
#include "base/strbuf.h"
#include "expr/lanes_sincos.h"
#include "expr/native_check.h"
#include "expr/native_emit.h"
#include "expr/tape_interpret.h"

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

// An interpreted instruction and a call of a tape take about so long [s]; only to decide when the
// queue is asked.
static const double PER_INSTRUCTION = 1.5e-9, PER_CALL = 20e-9;
static const double LANES_SHARE = 4; // of the time of one state, for all lanes
// Longer straight-line code no longer fits the processor's caches: at 46,000 instructions it is as
// slow as the interpreter, at 66,000 it takes 1.4 times as long (ladders of 450 and 650 loops).
// In lanes the same code serves many states.
enum { MOST_SINGLE = 40000, MOST_IN_LANES = 400000 };

/// One tape in the queue, with a copy of it: the tape itself may be freed meanwhile.
typedef struct job {
    struct job *next;
    hn_tape *copy;
    hn_native_state *state;
    bool build;
} job;

/// The service. The one mutable state of this layer: compiled code is the process's as the compiler
/// is.
static struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    pthread_t thread;
    bool started;            // tapes are to be compiled
    bool is_open, is_broken; // folder, compiler and thread are there, or one of them is not
    atomic_bool ending;
    bool busy;
    hn_native_opts opts;
    char folder[HN_NATIVE_PATH];
    hn_native_builder builder;
    job *first, **end;
    hn_native_counts counts;
    char reason[HN_DIAG_MESSAGE];
} service = {.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};

/// Compiled code, shared by all tapes that are equal.
struct hn_native_loaded {
    hn_tape *tape; ///< a copy of what was compiled
    hn_native_form form;
    uint64_t hash;
    void *handle;
    hn_native_code code;
    int refs;           ///< states, and the table below
    unsigned long used; ///< of the table's count of uses, the last
};

/// The code that has been loaded lately: the next run of a scene has it from its first step.
enum { KNOWN = 128 };
static struct {
    pthread_mutex_t lock;
    hn_native_loaded *item[KNOWN];
    int n;
    unsigned long uses;
} known = {.lock = PTHREAD_MUTEX_INITIALIZER};

static hn_native_call calls[HN_NATIVE_CALLS];
static _Thread_local int suspended;

hn_native_opts hn_native_opts_default(const char *folder) {
    return (hn_native_opts){
        .folder = folder, .time_limit = 60, .look_after = 0.002, .build_after = 0.02};
}

// ---- copies of tapes ----

static void *copy_of(const void *bytes, size_t n) {
    void *copy = malloc(n + 1);
    return copy ? memcpy(copy, bytes, n) : NULL;
}

static void free_copy(hn_tape *t) {
    if (t) {
        free(t->code);
        free(t->constants);
        free(t->outputs);
        free(t);
    }
}

static hn_tape *copy_tape(const hn_tape *tape) {
    hn_tape *t = copy_of(tape, sizeof *tape);
    if (!t) {
        return NULL;
    }
    t->native = NULL;
    t->sharers = NULL;
    t->code = copy_of(tape->code, ((size_t)tape->info.instructions + 1) * sizeof *t->code);
    t->constants = copy_of(tape->constants, (size_t)tape->n_constants * sizeof *t->constants);
    t->outputs = copy_of(tape->outputs, (size_t)tape->info.n_outputs * sizeof *t->outputs);
    if (!t->code || !t->constants || !t->outputs) {
        free_copy(t);
        return NULL;
    }
    return t;
}

// ---- code that is loaded ----

static uint64_t hash_of(const hn_tape *t) {
    uint64_t hash = 0;
    hash = hn_hash_bytes(hash, t->code, ((size_t)t->info.instructions + 1) * sizeof *t->code);
    hash = hn_hash_bytes(hash, t->constants, (size_t)t->n_constants * sizeof *t->constants);
    hash = hn_hash_bytes(hash, &t->check.pair, sizeof t->check.pair);
    return hn_hash_bytes(hash, t->outputs, (size_t)t->info.n_outputs * sizeof *t->outputs);
}

static bool same_tape(const hn_tape *a, const hn_tape *b) {
    return memcmp(&a->info, &b->info, sizeof a->info) == 0 && a->n_constants == b->n_constants &&
           hn_tape_check_equals(&a->check, &b->check) &&
           memcmp(a->code, b->code, ((size_t)a->info.instructions + 1) * sizeof *a->code) == 0 &&
           memcmp(a->constants, b->constants, (size_t)a->n_constants * sizeof *a->constants) == 0 &&
           memcmp(a->outputs, b->outputs, (size_t)a->info.n_outputs * sizeof *a->outputs) == 0;
}

/// With the lock of the table held.
static void release_loaded(hn_native_loaded *l) {
    if (--l->refs == 0) {
        dlclose(l->handle);
        free_copy(l->tape);
        free(l);
    }
}

static bool knows_any(void) {
    pthread_mutex_lock(&known.lock);
    const bool any = known.n > 0;
    pthread_mutex_unlock(&known.lock);
    return any;
}

static hn_native_loaded *find_loaded(const hn_tape *tape, hn_native_form form) {
    if (!knows_any()) {
        return NULL; // as in every short run: no hash is needed
    }
    const uint64_t hash = hash_of(tape);
    hn_native_loaded *found = NULL;
    pthread_mutex_lock(&known.lock);
    for (int i = 0; i < known.n && !found; i++) {
        hn_native_loaded *l = known.item[i];
        if (l->hash == hash && l->form == form && same_tape(l->tape, tape)) {
            found = l;
            l->refs++;
            l->used = ++known.uses;
        }
    }
    pthread_mutex_unlock(&known.lock);
    return found;
}

/// Takes over `tape`; the table lets go of what was used longest ago where it is full.
static hn_native_loaded *keep_loaded(hn_tape *tape, hn_native_form form, void *handle,
                                     hn_native_code code) {
    hn_native_loaded *l = calloc(1, sizeof *l);
    if (!l) {
        return NULL;
    }

    // two references: the table and the caller
    pthread_mutex_lock(&known.lock);
    *l = (hn_native_loaded){.tape = tape,
                            .form = form,
                            .hash = hash_of(tape),
                            .handle = handle,
                            .code = code,
                            .refs = 2,
                            .used = ++known.uses};

    // a place: a free one, or that of the entry unused for longest
    int place = known.n;
    if (known.n == KNOWN) {
        place = 0;
        for (int i = 1; i < KNOWN; i++) {
            place = known.item[i]->used < known.item[place]->used ? i : place;
        }
        release_loaded(known.item[place]);
    } else {
        known.n++;
    }

    known.item[place] = l;
    pthread_mutex_unlock(&known.lock);
    return l;
}

static void forget_loaded(void) {
    pthread_mutex_lock(&known.lock);
    while (known.n > 0) {
        release_loaded(known.item[--known.n]);
    }
    pthread_mutex_unlock(&known.lock);
}

// ---- states ----

static int runs_in(double seconds, const hn_tape *tape, hn_native_form form) {
    const double states = form == HN_NATIVE_SINGLE ? 1 : LANES_SHARE;
    const double each = PER_CALL + states * PER_INSTRUCTION * tape->info.instructions;
    return (int)fmin(1e9, ceil(seconds / each));
}

hn_native_state *hn_native_state_create(const hn_tape *tape, hn_native_form form) {
    const int most = form == HN_NATIVE_SINGLE ? MOST_SINGLE : MOST_IN_LANES;
    if (!service.started || suspended > 0 || tape->info.instructions > most) {
        return NULL;
    }
    hn_native_state *s = calloc(1, sizeof *s);
    if (s) {
        s->form = form;
        s->look_at = runs_in(service.opts.look_after, tape, form);
        s->build_at = runs_in(service.opts.build_after, tape, form);
        s->look_at = s->look_at > 1 ? s->look_at : 1;
        s->build_at = s->build_at > s->look_at ? s->build_at : s->look_at + 1;
        atomic_init(&s->refs, 1);
        s->calls = calls;
        s->loaded = find_loaded(tape, form);
        atomic_init(&s->code, s->loaded ? s->loaded->code : NULL);
    }
    return s;
}

void hn_native_state_release(hn_native_state *s) {
    if (s && atomic_fetch_sub(&s->refs, 1) == 1) {
        if (s->loaded) {
            pthread_mutex_lock(&known.lock);
            release_loaded(s->loaded);
            pthread_mutex_unlock(&known.lock);
        }
        free(s);
    }
}

void hn_native_suspend(void) {
    suspended++;
}

void hn_native_resume(void) {
    HN_ASSERT(suspended > 0);
    suspended--;
}

// ---- the work ----

static hn_status emit(const hn_tape *tape, hn_native_form form, hn_strbuf *text, hn_diag *diag) {
    const hn_status status = hn_native_emit(text, tape, form);
    return status == HN_OK
               ? HN_OK
               : hn_diag_set(diag, status, NULL, NULL, "the equations cannot be written as C: %s",
                             hn_status_text(status));
}

static void take_sincos(void) {
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        calls[HN_NATIVE_SINCOS + set] =
            (hn_native_call)(void (*)(void))hn_lanes_sincos_get((hn_lanes_set)set);
    }
    calls[HN_NATIVE_FOUR] = (hn_native_call)(void (*)(void))hn_lanes_sincos_four_get();
}

static hn_status load_checked(const hn_tape *tape, hn_native_form form, const hn_strbuf *text,
                              void **handle, hn_native_code *code, hn_diag *diag) {
    const hn_status status = hn_native_load(&service.builder, text->text, text->n, handle, code);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL,
                           "compiled code could not be loaded from %.200s", service.builder.folder);
    }

    // not at the start of the program: the vector form is compared with the C library first
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, take_sincos);
    if (hn_native_agrees(tape, form, *code, calls)) {
        return HN_OK;
    }
    dlclose(*handle);
    return hn_diag_set(diag, HN_ERR_INTERNAL, NULL, NULL,
                       "%s makes code that differs from the interpreter", service.builder.compiler);
}

/// From the folder, or by the compiler where `build` allows it. *cached: it was in the folder.
static hn_status obtain(const hn_tape *tape, hn_native_form form, bool build, void **handle,
                        hn_native_code *code, bool *cached, hn_diag *diag) {
    double seconds;
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = emit(tape, form, &text, diag);
    if (status == HN_OK) {
        status = load_checked(tape, form, &text, handle, code, diag);
        *cached = status == HN_OK;
    }
    if (status != HN_OK && build && text.n > 0) {
        status = hn_native_build(&service.builder, text.text, text.n, &seconds, diag);
        HN_THEN(status, load_checked(tape, form, &text, handle, code, diag));
    }
    hn_strbuf_reset(&text);
    return status;
}

/// The code serves the tape of the job from now on; the job's copy of it goes to the table.
static hn_status take_code(job *j, void *handle, hn_native_code code) {
    hn_native_loaded *l = keep_loaded(j->copy, j->state->form, handle, code);
    if (!l) {
        dlclose(handle);
        return HN_ERR_MEMORY;
    }
    j->copy = NULL;
    j->state->loaded = l;
    atomic_store_explicit(&j->state->code, code, memory_order_release);
    return HN_OK;
}

static void do_job(job *j) {
    hn_diag diag = {0};
    hn_native_code code = NULL;
    bool cached = false;
    if (atomic_load(&j->state->code)) {
        return; // the look before the build found it
    }
    void *handle = NULL;
    hn_status status = obtain(j->copy, j->state->form, j->build, &handle, &code, &cached, &diag);
    HN_THEN(status, take_code(j, handle, code));
    pthread_mutex_lock(&service.lock);
    if (status == HN_OK) {
        service.counts.ready++;
        service.counts.from_cache += cached;
    } else if (j->build) {
        service.counts.failed++;
        memcpy(service.reason, diag.message, sizeof service.reason);
    }
    pthread_mutex_unlock(&service.lock);
}

static void free_job(job *j) {
    hn_native_state_release(j->state);
    free_copy(j->copy);
    free(j);
}

static void *work(void *unused) {
    (void)unused;
    pthread_mutex_lock(&service.lock);
    while (!atomic_load(&service.ending)) {
        job *j = service.first;
        if (!j) {
            pthread_cond_wait(&service.changed, &service.lock);
            continue;
        }
        service.first = j->next;
        if (!service.first) {
            service.end = &service.first;
        }

        // nobody waits for the queue while a compiler runs
        service.busy = true;
        pthread_mutex_unlock(&service.lock);
        do_job(j);
        free_job(j);
        pthread_mutex_lock(&service.lock);
        service.busy = false;
        pthread_cond_broadcast(&service.changed);
    }
    pthread_mutex_unlock(&service.lock);
    return NULL;
}

// ---- start and end ----

void hn_native_start(const hn_native_opts *opts) {
    HN_ASSERT(!service.started && opts->folder);
    for (int op = 0; op < HN_OP_COUNT; op++) {
        calls[op] = hn_op_get_info((hn_op)op)->value;
    }
    service.opts = *opts;
    snprintf(service.folder, sizeof service.folder, "%s", opts->folder);
    service.opts.folder = service.folder;
    service.end = &service.first;
    service.counts = (hn_native_counts){0};
    service.reason[0] = '\0';
    service.is_open = service.is_broken = false;
    atomic_store(&service.ending, false);
    service.started = true;
}

/// Starts the thread. It takes no signals: they belong to the threads that wait for them.
static bool start_thread(void) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const bool runs = pthread_create(&service.thread, NULL, work, NULL) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return runs;
}

/// Looks for folder and compiler and starts the thread, once; with the lock held.
static bool open_service(void) {
    if (service.is_open || service.is_broken || atomic_load(&service.ending)) {
        return service.is_open;
    }
    hn_diag diag = {0};
    hn_status status = hn_native_builder_init(
        &service.builder, service.folder, service.opts.compiler, service.opts.time_limit, &diag);
    service.builder.ending = &service.ending;
    if (status == HN_OK && !start_thread()) {
        status = hn_diag_set(&diag, HN_ERR_MEMORY, NULL, NULL, "no thread to compile machine code");
    }
    service.is_open = status == HN_OK;
    service.is_broken = !service.is_open;
    if (service.is_broken) {
        memcpy(service.reason, diag.message, sizeof service.reason);
    }
    return service.is_open;
}

static void ask(const hn_tape *tape, hn_native_state *state, bool build) {
    job *j = calloc(1, sizeof *j);
    hn_tape *copy = j ? copy_tape(tape) : NULL;
    if (!copy) {
        free(j);
        return;
    }
    *j = (job){.copy = copy, .state = state, .build = build};
    atomic_fetch_add(&j->state->refs, 1);
    pthread_mutex_lock(&service.lock);
    const bool takes = service.started && open_service();
    if (takes) {
        *service.end = j;
        service.end = &j->next;
        pthread_cond_broadcast(&service.changed);
    }
    pthread_mutex_unlock(&service.lock);
    if (!takes) {
        free_job(j);
    }
}

void hn_native_count(const hn_tape *tape, hn_native_state *s) {
    // a load and a store in place of an atomic increment: threads that share a tape may lose some
    // runs, which only delays it
    const int runs = 1 + atomic_load_explicit(&s->runs, memory_order_relaxed);
    if (runs > s->build_at) {
        return;
    }
    atomic_store_explicit(&s->runs, runs, memory_order_relaxed);
    if (runs == s->look_at || runs == s->build_at) {
        ask(tape, s, runs == s->build_at);
    }
}

void hn_native_stay_off(const char *why) {
    pthread_mutex_lock(&service.lock);
    snprintf(service.reason, sizeof service.reason, "%s", why);
    pthread_mutex_unlock(&service.lock);
}

void hn_native_stop(void) {
    if (!service.started) {
        return;
    }
    pthread_mutex_lock(&service.lock);
    atomic_store(&service.ending, true);
    pthread_cond_broadcast(&service.changed);
    pthread_mutex_unlock(&service.lock);
    if (service.is_open) {
        pthread_join(service.thread, NULL);
    }
    for (job *j = service.first, *next; j; j = next) {
        next = j->next;
        free_job(j);
    }
    service.first = NULL;
    service.started = service.is_open = false;
    forget_loaded();
}

void hn_native_wait(void) {
    pthread_mutex_lock(&service.lock);
    while (service.started && (service.first || service.busy)) {
        pthread_cond_wait(&service.changed, &service.lock);
    }
    pthread_mutex_unlock(&service.lock);
}

hn_native_counts hn_native_get_counts(void) {
    pthread_mutex_lock(&service.lock);
    const hn_native_counts counts = service.counts;
    pthread_mutex_unlock(&service.lock);
    return counts;
}

void hn_native_reason(char out[HN_DIAG_MESSAGE]) {
    pthread_mutex_lock(&service.lock);
    memcpy(out, service.reason, HN_DIAG_MESSAGE);
    pthread_mutex_unlock(&service.lock);
}

// ---- costs ----

enum { BATCHES = 9 };
static const double BATCH = 2e-4; // [s] of one batch: a hundred times the clock's grain

/// Smallest time of one evaluation over BATCHES batches [s]; code NULL: the interpreter. It takes
/// turns between the two workspaces w[0 .. slots - 1] and behind: sine and cosine of angles that
/// stay would be found once only.
static double time_of(const hn_tape *tape, hn_native_code code, double *w) {
    double *const in_turn[2] = {w, w + tape->info.slots};
    double best = (double)INFINITY;
    const int n = 1 + runs_in(BATCH, tape, HN_NATIVE_SINGLE);
    for (int k = 0; k < BATCHES; k++) {
        const double start = hn_clock_thread();
        for (int i = 0; i < n; i++) {
            if (code) {
                code(in_turn[i % 2], calls);
            } else {
                hn_tape_interpret(tape, in_turn[i % 2]);
            }
        }
        best = fmin(best, (hn_clock_thread() - start) / n);
    }
    return best;
}

static hn_status compile_measured(const hn_tape *tape, const hn_strbuf *text,
                                  hn_native_costs *costs, void **handle, hn_native_code *code,
                                  hn_diag *diag) {
    double start = hn_clock_wall();
    hn_status status = load_checked(tape, HN_NATIVE_SINGLE, text, handle, code, diag);
    if (status != HN_OK) {
        HN_TRY(
            hn_native_build(&service.builder, text->text, text->n, &costs->compile_seconds, diag));
        start = hn_clock_wall();
        status = load_checked(tape, HN_NATIVE_SINGLE, text, handle, code, diag);
    }
    costs->load_seconds = hn_clock_wall() - start;
    return status;
}

hn_status hn_native_measure(const hn_tape *tape, hn_native_costs *costs, hn_diag *diag) {
    *costs = (hn_native_costs){.instructions = tape->info.instructions};
    if (tape->info.instructions > MOST_SINGLE) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL,
                           "the equations have %d instructions; machine code of more than %d is "
                           "slower than the interpreter",
                           tape->info.instructions, MOST_SINGLE);
    }
    pthread_mutex_lock(&service.lock);
    const bool is_open = service.started && open_service();
    pthread_mutex_unlock(&service.lock);
    if (!is_open) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL, "%s",
                           service.reason[0] ? service.reason : "machine code is switched off");
    }

    // a tape of its own, compiled aside
    void *handle = NULL;
    hn_native_code code = NULL;
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_tape *copy = copy_tape(tape);
    double *w = malloc(2 * ((size_t)tape->info.slots + 1) * sizeof *w);
    double start = hn_clock_wall();
    hn_status status = copy && w ? emit(copy, HN_NATIVE_SINGLE, &text, diag) : HN_ERR_MEMORY;
    costs->emit_seconds = hn_clock_wall() - start;
    HN_THEN(status, compile_measured(copy, &text, costs, &handle, &code, diag));

    // times of both, and the run length from which compiling pays
    if (status == HN_OK) {
        for (int k = 0; k < 2; k++) { // no round numbers, so that no function takes a short cut
            double *const x = w + k * copy->info.slots;
            hn_native_prepare(copy, x);
            hn_native_fill(x, copy->info.n_inputs, 2 + k);
        }
        costs->interpreter_ns = 1e9 * time_of(copy, NULL, w);
        costs->native_ns = 1e9 * time_of(copy, code, w);
        const double saved = 1e-9 * (costs->interpreter_ns - costs->native_ns),
                     spent = costs->emit_seconds + costs->compile_seconds + costs->load_seconds;
        costs->break_even = saved > 0 ? ceil(spent / saved) : (double)INFINITY;
        dlclose(handle);
    }
    hn_strbuf_reset(&text);
    free_copy(copy);
    free(w);
    return status;
}
