// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/shares.h"

#include <pthread.h>
#include <stdlib.h>

typedef struct share {
    hn_client client;
    int n;
} share;

struct hn_shares {
    pthread_mutex_t lock;
    int in_all, per_client;
    int taken, n_clients;
    share *client; ///< those that hold places; at most as many as there are places
};

hn_shares *hn_shares_create(int in_all, int per_client) {
    hn_shares *shares = calloc(1, sizeof *shares);
    if (!shares) {
        return NULL;
    }
    pthread_mutex_init(&shares->lock, NULL);
    shares->in_all = in_all;
    shares->per_client = per_client;
    shares->client = calloc((size_t)in_all, sizeof *shares->client);
    if (!shares->client) {
        hn_shares_free(shares);
        return NULL;
    }
    return shares;
}

void hn_shares_free(hn_shares *shares) {
    if (shares) {
        pthread_mutex_destroy(&shares->lock);
        free(shares->client);
        free(shares);
    }
}

/// The client's row; a new one is at the end of those in use.
static int find_row(const hn_shares *shares, hn_client client) {
    int i = 0;
    while (i < shares->n_clients && shares->client[i].client != client) {
        i++;
    }
    return i;
}

/// The places that row i holds, and whether its client may have one more. With the lock held.
static bool may_take(const hn_shares *shares, hn_client client, int i, int *held) {
    *held = i < shares->n_clients ? shares->client[i].n : 0;
    return shares->taken < shares->in_all && (client == 0 || *held < shares->per_client);
}

bool hn_shares_has_place(hn_shares *shares, hn_client client) {
    int held;
    pthread_mutex_lock(&shares->lock);
    const bool has = may_take(shares, client, find_row(shares, client), &held);
    pthread_mutex_unlock(&shares->lock);
    return has;
}

bool hn_shares_has_share(hn_shares *shares, hn_client client) {
    pthread_mutex_lock(&shares->lock);
    const int i = find_row(shares, client);
    const int held = i < shares->n_clients ? shares->client[i].n : 0;
    pthread_mutex_unlock(&shares->lock);
    return client != 0 && held >= shares->per_client;
}

hn_client hn_shares_greediest(hn_shares *shares) {
    share greediest = {0};
    pthread_mutex_lock(&shares->lock);
    for (int i = 0; i < shares->n_clients; i++) {
        greediest = shares->client[i].n > greediest.n ? shares->client[i] : greediest;
    }
    pthread_mutex_unlock(&shares->lock);
    return greediest.client;
}

int hn_shares_take(hn_shares *shares, hn_client client) {
    int held;
    pthread_mutex_lock(&shares->lock);
    const int i = find_row(shares, client);
    const int free_place = may_take(shares, client, i, &held);
    if (free_place) {
        shares->client[i] = (share){.client = client, .n = held + 1};
        shares->n_clients += i == shares->n_clients;
        shares->taken++;
    }
    pthread_mutex_unlock(&shares->lock);
    return free_place;
}

void hn_shares_give(hn_shares *shares, hn_client client) {
    pthread_mutex_lock(&shares->lock);
    const int i = find_row(shares, client);
    if (--shares->client[i].n == 0) {
        shares->client[i] = shares->client[--shares->n_clients];
    }
    shares->taken--;
    pthread_mutex_unlock(&shares->lock);
}

int hn_shares_taken(hn_shares *shares) {
    pthread_mutex_lock(&shares->lock);
    const int taken = shares->taken;
    pthread_mutex_unlock(&shares->lock);
    return taken;
}
