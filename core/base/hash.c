// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hash.h"

#include <string.h>

// FNV-1a, 64 bits: Fowler, Noll & Vo, IETF draft-eastlake-fnv, section 5.
static const uint64_t FNV_PRIME = 0x100000001b3ull;

uint64_t hn_hash_bytes(uint64_t hash, const void *bytes, size_t n) {
    const unsigned char *b = bytes;
    for (size_t i = 0; i < n; i++) {
        hash = (hash ^ b[i]) * FNV_PRIME;
    }
    return hash;
}

uint64_t hn_hash_text(uint64_t hash, const char *text) {
    // the zero is hashed too, so that ("ab", "c") and ("a", "bc") differ
    return hn_hash_bytes(hash, text, strlen(text) + 1);
}

uint64_t hn_hash_double(uint64_t hash, double value) {
    const double canonical = value == 0 ? 0.0 : value;
    uint64_t bits;
    memcpy(&bits, &canonical, sizeof bits);

    // byte by byte from the lowest, so that the hash does not depend on the machine's byte order
    for (int i = 0; i < 8; i++) {
        hash = (hash ^ (bits >> (8 * i) & 0xff)) * FNV_PRIME;
    }
    return hash;
}

// The finaliser of MurmurHash3 (Appleby, public domain): FNV's low bits depend on the low bits of
// the input alone, and tables are indexed by low bits.
uint64_t hn_hash_mix(uint64_t hash) {
    hash ^= hash >> 33;
    hash *= 0xff51afd7ed558ccdull;
    hash ^= hash >> 33;
    hash *= 0xc4ceb9fe1a85ec53ull;
    hash ^= hash >> 33;
    return hash;
}

void hn_hash_hex(uint64_t hash, char out[17]) {
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < 16; i++) {
        out[i] = digits[hash >> (60 - 4 * i) & 15];
    }
    out[16] = '\0';
}
