// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SHARES_H
#define HN_HTTP_SHARES_H
// Places of one kind (streams, comparisons), so many in all and so many for one client.

#include <stdbool.h>
#include <stdint.h>

/// A client: a hash of its address. 0 is this machine, whose share is everything.
typedef uint64_t hn_client;

typedef struct hn_shares hn_shares;

/// NULL when memory is out.
hn_shares *hn_shares_create(int in_all, int per_client);
void hn_shares_free(hn_shares *shares); ///< NULL is legal
/// Takes a place. Returns 1, or 0 when there is none left, in all or for this client.
int hn_shares_take(hn_shares *shares, hn_client client);
/// Returns whether a place could be taken now.
bool hn_shares_has_place(hn_shares *shares, hn_client client);
/// Returns whether the client holds as many places as one client may.
bool hn_shares_has_share(hn_shares *shares, hn_client client);
/// Returns the client that holds the most places; 0 when nobody holds any.
hn_client hn_shares_greediest(hn_shares *shares);
void hn_shares_give(hn_shares *shares, hn_client client);
int hn_shares_taken(hn_shares *shares);
#endif
