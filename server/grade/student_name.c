// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/student_name.h"

#include "base/hash.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// For each combining mark: letters, each followed by the same letter with the mark. These are the
/// canonical pairs of Unicode's UnicodeData.txt for the Latin, Greek and Cyrillic letters and kana.
static const struct {
    unsigned mark;
    const char *pairs;
} MARKS[] = {
    // clang-format off
    {0x0300, "AÀEÈIÌOÒUÙaàeèiìoòuùÜǛüǜNǸnǹЕЀИЍеѐиѝĒḔēḕŌṐ"
     "ōṑWẀwẁÂẦâầĂẰăằÊỀêềÔỒôồƠỜơờƯỪưừ"
     "YỲyỳ"},
    {0x0301, "AÁEÉIÍOÓUÚYÝaáeéiíoóuúyýCĆcćLĹlĺNŃnńRŔrŕSŚsśZŹzźÜǗ"
     "üǘGǴgǵÅǺåǻÆǼæǽØǾøǿ¨΅ΑΆΕΈΗΉΙΊΟΌΥΎΩΏϊΐαά"
     "εέηήιίϋΰοόυύωώϒϓГЃКЌгѓкќÇḈçḉĒḖēḗÏḮ"
     "ïḯKḰkḱMḾmḿÕṌõṍŌṒōṓPṔpṕŨṸũṹWẂwẃÂẤ"
     "âấĂẮăắÊẾêếÔỐôốƠỚơớƯỨưứ"},
    {0x0302, "AÂEÊIÎOÔUÛaâeêiîoôuûCĈcĉGĜgĝHĤhĥJĴjĵSŜsŝWŴwŵYŶyŷZẐ"
     "zẑẠẬạậẸỆẹệỌỘọộ"},
    {0x0303, "AÃNÑOÕaãnñoõIĨiĩUŨuũVṼvṽÂẪâẫĂẴăẵEẼeẽÊỄêễ"
     "ÔỖôỗƠỠơỡƯỮưữYỸyỹ"},
    {0x0304, "AĀaāEĒeēIĪiīOŌoōUŪuūÜǕüǖÄǞäǟȦǠȧǡÆǢæǣǪǬǫǭÖȪ"
     "öȫÕȬõȭȮȰȯȱYȲyȳИӢиӣУӮуӯGḠgḡḶḸḷḹṚṜṛṝ"},
    {0x0306, "AĂaăEĔeĕGĞgğIĬiĭOŎoŏUŬuŭУЎИЙийуўЖӁжӂАӐаӑЕӖеӗ"
     "ȨḜȩḝẠẶạặ"},
    {0x0307, "CĊcċEĖeėGĠgġIİZŻzżAȦaȧOȮoȯBḂbḃDḊdḋFḞfḟHḢhḣMṀ"
     "mṁNṄnṅPṖpṗRṘrṙSṠsṡŚṤśṥŠṦšṧṢṨṣṩTṪtṫ"
     "WẆwẇXẊxẋYẎyẏſẛ"},
    {0x0308, "AÄEËIÏOÖUÜaäeëiïoöuüyÿYŸΙΪΥΫιϊυϋϒϔЕЁІЇеёіїАӒ"
     "аӓӘӚәӛЖӜжӝЗӞзӟИӤиӥОӦоӧӨӪөӫЭӬэӭУӰуӱЧӴчӵ"
     "ЫӸыӹHḦhḧÕṎõṏŪṺūṻWẄwẅXẌxẍtẗ"},
    {0x0309, "AẢaảÂẨâẩĂẲăẳEẺeẻÊỂêểIỈiỉOỎoỏÔỔôổ"
     "ƠỞơởUỦuủƯỬưửYỶyỷ"},
    {0x030A, "AÅaåUŮuůwẘyẙ"},
    {0x030B, "OŐoőUŰuűУӲуӳ"},
    {0x030C, "CČcčDĎdďEĚeěLĽlľNŇnňRŘrřSŠsšTŤtťZŽzžAǍaǎIǏiǐOǑoǒUǓ"
     "uǔÜǙüǚGǦgǧKǨkǩƷǮʒǯjǰHȞhȟ"},
    {0x030F, "AȀaȁEȄeȅIȈiȉOȌoȍRȐrȑUȔuȕѴѶѵѷ"},
    {0x0311, "AȂaȃEȆeȇIȊiȋOȎoȏRȒrȓUȖuȗ"},
    {0x031B, "OƠoơUƯuư"},
    {0x0323, "BḄbḅDḌdḍHḤhḥKḲkḳLḶlḷMṂmṃNṆnṇRṚrṛSṢsṣTṬ"
     "tṭVṾvṿWẈwẉZẒzẓAẠaạEẸeẹIỊiịOỌoọƠỢơợUỤ"
     "uụƯỰưựYỴyỵ"},
    {0x0324, "UṲuṳ"},
    {0x0325, "AḀaḁ"},
    {0x0326, "SȘsșTȚtț"},
    {0x0327, "CÇcçGĢgģKĶkķLĻlļNŅnņRŖrŗSŞsşTŢtţEȨeȩDḐdḑHḨhḩ"},
    {0x0328, "AĄaąEĘeęIĮiįUŲuųOǪoǫ"},
    {0x032D, "DḒdḓEḘeḙLḼlḽNṊnṋTṰtṱUṶuṷ"},
    {0x032E, "HḪhḫ"},
    {0x0330, "EḚeḛIḬiḭUṴuṵ"},
    {0x0331, "BḆbḇDḎdḏKḴkḵLḺlḻNṈnṉRṞrṟTṮtṯZẔzẕhẖ"},
    {0x3099, "かがきぎくぐけげこごさざしじすずせぜそぞただちぢ"
     "つづてでとどはばひびふぶへべほぼうゔゝゞカガキギ"
     "クグケゲコゴサザシジスズセゼソゾタダチヂツヅテデ"
     "トドハバヒビフブヘベホボウヴワヷヰヸヱヹヲヺヽヾ"},
    {0x309A, "はぱひぴふぷへぺほぽハパヒピフプヘペホポ"},
    // clang-format on
};

// Hangul syllables are made by arithmetic: section 3.12 of the Unicode standard
enum {
    HANGUL_FIRST = 0xAC00,
    HANGUL_LEAD = 0x1100,
    HANGUL_VOWEL = 0x1161,
    HANGUL_TAIL = 0x11A7,
    HANGUL_LEADS = 19,
    HANGUL_VOWELS = 21,
    HANGUL_TAILS = 28
};

/// Reads one character of UTF-8 from *at; a byte that begins none is read as it is, above 0x10FFFF.
static unsigned read_character(const char **at) {
    static const struct {
        unsigned char mask, begins, data;
        int more;
    } SHAPES[] = {
        {0x80, 0x00, 0x7F, 0}, {0xE0, 0xC0, 0x1F, 1}, {0xF0, 0xE0, 0x0F, 2}, {0xF8, 0xF0, 0x07, 3}};
    const unsigned char *p = (const unsigned char *)*at;
    for (size_t i = 0; i < sizeof SHAPES / sizeof *SHAPES; i++) {
        unsigned c = *p & SHAPES[i].data;
        int k = 1;
        while (k <= SHAPES[i].more && (p[k] & 0xC0) == 0x80) {
            c = c << 6 | (p[k++] & 0x3F);
        }
        if ((*p & SHAPES[i].mask) == SHAPES[i].begins && k > SHAPES[i].more) {
            *at += k;
            return c;
        }
    }
    *at += 1;
    return 0x110000u + *p;
}

/// The letter with the mark, or 0 where there is no such letter.
static unsigned compose(unsigned letter, unsigned mark) {
    const unsigned lead = letter - HANGUL_LEAD, vowel = mark - HANGUL_VOWEL;
    if (lead < HANGUL_LEADS && vowel < HANGUL_VOWELS) {
        return HANGUL_FIRST + (lead * HANGUL_VOWELS + vowel) * HANGUL_TAILS;
    }
    const unsigned syllable = letter - HANGUL_FIRST, tail = mark - HANGUL_TAIL;
    if (syllable < HANGUL_LEADS * HANGUL_VOWELS * HANGUL_TAILS && syllable % HANGUL_TAILS == 0 &&
        tail > 0 && tail < HANGUL_TAILS) {
        return letter + tail;
    }
    for (size_t i = 0; i < sizeof MARKS / sizeof *MARKS; i++) {
        for (const char *at = MARKS[i].pairs; MARKS[i].mark == mark && *at;) {
            const unsigned plain = read_character(&at), marked = read_character(&at);
            if (plain == letter) {
                return marked;
            }
        }
    }
    return 0;
}

static bool is_blank(unsigned c) {
    return c == ' ' || (c >= '\t' && c <= '\r') || c == 0xA0;
}

static const char *skip_blanks(const char *at) {
    const char *behind = at;
    while (is_blank(read_character(&behind))) {
        at = behind;
    }
    return at;
}

/// Writes a character in UTF-8; returns its bytes.
static size_t write_character(unsigned c, char out[4]) {
    static const unsigned char BEGINS[] = {0, 0xC0, 0xE0, 0xF0};
    const size_t more = c < 0x80 || c > 0x10FFFF ? 0 : c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    for (size_t k = more; k > 0; k--) {
        out[k] = (char)(0x80 | (c & 0x3F));
        c >>= 6;
    }
    out[0] = (char)(BEGINS[more] | (c & 0xFF));
    return more + 1;
}

/// The next character of a name as it is compared; 0 bytes at its end.
static size_t next_character(const char **at, char out[4]) {
    const char *behind = *at;
    unsigned c = **at ? read_character(&behind) : ' ';
    if (is_blank(c)) {
        *at = skip_blanks(*at);
        out[0] = ' ';
        return **at != '\0';
    }

    // its marks, one after the other
    for (*at = behind; *behind; *at = behind) {
        const unsigned composed = compose(c, read_character(&behind));
        if (!composed) {
            break;
        }
        c = composed;
    }
    return write_character(c, out);
}

uint64_t hn_student_name_hash(uint64_t hash, const char *name) {
    char character[4];
    name = skip_blanks(name);
    for (size_t n; (n = next_character(&name, character)) > 0;) {
        hash = hn_hash_bytes(hash, character, n);
    }
    return hn_hash_bytes(hash, "", 1); // its end counts, as in hn_hash_text()
}

void hn_student_name_normalise(const char *name, char *out, size_t size) {
    char character[4];
    size_t used = 0;
    name = skip_blanks(name);
    for (size_t n; (n = next_character(&name, character)) > 0 && used + n < size; used += n) {
        memmove(out + used, character, n);
    }
    out[used] = '\0';
}
