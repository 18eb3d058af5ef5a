// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/jobs.h"

#include "base/clock.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

/// Weight of the latest job in the mean duration.
static const double LATEST = 0.2;

typedef struct job {
    void *work;
    hn_client client;
} job;

struct hn_jobs {
    pthread_mutex_t lock;
    pthread_cond_t more;
    void (*run)(void *work);
    job *waiting; ///< oldest first
    int cap, per_client, n, stopping;
    int n_threads, n_running;
    pthread_t *threads;
    hn_client *running; ///< of each thread
    char *is_running;
    double mean; ///< duration of a job [s]
};

typedef struct worker {
    hn_jobs *jobs;
    int place;
} worker;

// ---- with the lock held ----

static int count_running(const hn_jobs *jobs, hn_client client) {
    int n = 0;
    for (int i = 0; i < jobs->n_threads; i++) {
        n += jobs->is_running[i] && jobs->running[i] == client;
    }
    return n;
}

static int count_waiting(const hn_jobs *jobs, hn_client client) {
    int n = 0;
    for (int i = 0; i < jobs->n; i++) {
        n += jobs->waiting[i].client == client;
    }
    return n;
}

/// The oldest job of the client that has the fewest at work.
static job take(hn_jobs *jobs) {
    int best = 0, fewest = count_running(jobs, jobs->waiting[0].client);
    for (int i = 1; i < jobs->n && fewest > 0; i++) {
        const int running = count_running(jobs, jobs->waiting[i].client);
        if (running < fewest) {
            fewest = running;
            best = i;
        }
    }
    const job taken = jobs->waiting[best];
    jobs->n--;
    memmove(&jobs->waiting[best], &jobs->waiting[best + 1],
            (size_t)(jobs->n - best) * sizeof *jobs->waiting);
    return taken;
}

// ---- threads ----

static void do_job(hn_jobs *jobs, int place) {
    const job taken = take(jobs);
    jobs->running[place] = taken.client;
    jobs->is_running[place] = 1;
    jobs->n_running++;
    pthread_mutex_unlock(&jobs->lock);

    const double begun = hn_clock_wall();
    jobs->run(taken.work);
    const double took = hn_clock_wall() - begun;

    pthread_mutex_lock(&jobs->lock);
    jobs->mean += LATEST * (took - jobs->mean);
    jobs->is_running[place] = 0;
    jobs->n_running--;
}

static void *work(void *arg) {
    worker w = *(worker *)arg;
    free(arg);
    pthread_mutex_lock(&w.jobs->lock);
    while (w.jobs->n > 0 || !w.jobs->stopping) {
        if (w.jobs->n > 0) {
            do_job(w.jobs, w.place);
        } else {
            pthread_cond_wait(&w.jobs->more, &w.jobs->lock);
        }
    }
    pthread_mutex_unlock(&w.jobs->lock);
    return NULL;
}

static bool start_thread(hn_jobs *jobs) {
    worker *w = malloc(sizeof *w);
    if (!w) {
        return false;
    }
    *w = (worker){.jobs = jobs, .place = jobs->n_threads};
    if (pthread_create(&jobs->threads[jobs->n_threads], NULL, work, w) != 0) {
        free(w);
        return false;
    }
    return true;
}

hn_jobs *hn_jobs_create(int n_threads, int n_waiting, int per_client, void (*run)(void *job)) {
    hn_jobs *jobs = calloc(1, sizeof *jobs);
    if (!jobs) {
        return NULL;
    }
    pthread_mutex_init(&jobs->lock, NULL);
    pthread_cond_init(&jobs->more, NULL);
    jobs->run = run;
    jobs->cap = n_waiting;
    jobs->per_client = per_client;
    jobs->waiting = calloc((size_t)n_waiting, sizeof *jobs->waiting);
    jobs->threads = calloc((size_t)n_threads, sizeof *jobs->threads);
    jobs->running = calloc((size_t)n_threads, sizeof *jobs->running);
    jobs->is_running = calloc((size_t)n_threads, 1);

    // a thread looks at nothing here before it has the lock
    const int complete = jobs->waiting && jobs->threads && jobs->running && jobs->is_running;
    pthread_mutex_lock(&jobs->lock);
    while (complete && jobs->n_threads < n_threads && start_thread(jobs)) {
        jobs->n_threads++;
    }
    pthread_mutex_unlock(&jobs->lock);
    if (jobs->n_threads < n_threads) {
        hn_jobs_free(jobs);
        return NULL;
    }
    return jobs;
}

int hn_jobs_push(hn_jobs *jobs, void *work_item, hn_client client) {
    pthread_mutex_lock(&jobs->lock);
    const int taken = !jobs->stopping && jobs->n < jobs->cap &&
                      (client == 0 || count_waiting(jobs, client) < jobs->per_client);
    if (taken) {
        jobs->waiting[jobs->n++] = (job){.work = work_item, .client = client};
        pthread_cond_signal(&jobs->more);
    }
    pthread_mutex_unlock(&jobs->lock);
    return taken;
}

int hn_jobs_wait(hn_jobs *jobs) {
    pthread_mutex_lock(&jobs->lock);
    const double seconds = jobs->mean * (jobs->n + 1) / jobs->n_threads;
    pthread_mutex_unlock(&jobs->lock);
    return (int)fmin(60, fmax(1, ceil(seconds)));
}

void hn_jobs_stop(hn_jobs *jobs) {
    if (!jobs) {
        return;
    }
    pthread_mutex_lock(&jobs->lock);
    jobs->stopping = 1;
    const int n = jobs->n_threads;
    pthread_cond_broadcast(&jobs->more);
    pthread_mutex_unlock(&jobs->lock);
    for (int i = 0; i < n; i++) {
        pthread_join(jobs->threads[i], NULL);
    }
    jobs->n_threads = 0;
}

void hn_jobs_free(hn_jobs *jobs) {
    if (jobs) {
        hn_jobs_stop(jobs);
        pthread_cond_destroy(&jobs->more);
        pthread_mutex_destroy(&jobs->lock);
        free(jobs->waiting);
        free(jobs->threads);
        free(jobs->running);
        free(jobs->is_running);
        free(jobs);
    }
}
