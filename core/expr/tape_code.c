// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/tape_code.h"

hn_tape_code_info hn_tape_get_code_info(int code) {
    static const hn_tape_code_info table[TAPE_SINCOS] = {
#define TAPE_ROW(name, key, n, expression) {#expression, key, n},
        HN_TAPE_OPS(TAPE_ROW)
#undef TAPE_ROW
    };
    return code >= 0 && code < TAPE_SINCOS ? table[code] : (hn_tape_code_info){0};
}

int hn_tape_operands(const hn_tape_instruction *i) {
    return i->code == TAPE_CALL2    ? 2
           : i->code >= TAPE_SINCOS ? 1
                                    : hn_tape_get_code_info(i->code).n_operands;
}
