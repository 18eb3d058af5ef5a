# SPDX-License-Identifier: GPL-3.0-or-later
# Compares the #include lines with the table of layers and rooms: "include what is below you, nothing else".
# usage: awk -v layers='base: linalg:base expr:base ...' -v rooms='study.run: study.cost:run ...' \
#            -f check-layers.awk FILES
# Prints file:line for each fault; exit 1 if there is any.

BEGIN {
    n = split(layers, entries, " ")
    for (i = 1; i <= n; i++) {
        split(entries[i], pair, ":")
        known[pair[1]] = 1
        allowed[pair[1], pair[1]] = 1
        m = split(pair[2], needs, ",")
        for (j = 1; j <= m; j++) allowed[pair[1], needs[j]] = 1
    }
    # a layer that has rooms has no files outside them
    n = split(rooms, entries, " ")
    for (i = 1; i <= n; i++) {
        split(entries[i], pair, ":")
        split(pair[1], name, ".")
        has_rooms[name[1]] = 1
        open_to[pair[1], name[2]] = 1
        m = split(pair[2], needs, ",")
        for (j = 1; j <= m; j++) open_to[pair[1], needs[j]] = 1
    }
    # a library is seen by these layers alone
    only["microhttpd"] = " server "
    only["cjson"] = " scene import session server "
    only["GL"] = " render "
    only["png"] = " render "
    only["gsl"] = " linalg integrators study "
    only["ncurses"] = " server "
    only["libxml2"] = " import "
}

function fault(text) {
    printf "%s:%d: %s\n", FILENAME, FNR, text
    faults++
}

# the folders of a path between its layer, parts[first], and the file: the room, "" outside of all
function room_of(parts, count, first,   room, i) {
    room = ""
    for (i = first + 1; i < count; i++) room = room (room == "" ? "" : "/") parts[i]
    return room
}

# `first`: where the layer stands in the header; 0 for the server, whose folders are written without it
function check_room(header, first,   parts, count, target_room) {
    count = split(header, parts, "/")
    target_room = room_of(parts, count, first)
    if (first == 0 && target_room == "") return
    if (!((layer "." room, target_room) in open_to))
        fault("room " layer "/" room " must not include " layer "/" target_room ": " header)
}

function library_of(header) {
    if (header ~ /^microhttpd/) return "microhttpd"
    if (header ~ /^cjson\//) return "cjson"
    if (header ~ /^GL\//) return "GL"
    if (header ~ /^png/) return "png"
    if (header ~ /^gsl\//) return "gsl"
    if (header ~ /^n?curses/) return "ncurses"
    if (header ~ /^libxml\//) return "libxml2"
    return ""
}

FNR == 1 {
    split(FILENAME, part, "/")
    first = part[1] == "core" ? 2 : 1
    layer = part[first]
    room = room_of(part, split(FILENAME, part, "/"), first)
    if ((layer in has_rooms) && !((layer "." room, room) in open_to))
        fault("the room '" room "' of " layer " is not in the table of the Makefile")
    if (!(layer in known)) fault("the layer '" layer "' is not in the table of the Makefile")
}

/^[ \t]*#[ \t]*include[ \t]*"/ {
    header = $0
    sub(/^[^"]*"/, "", header)
    sub(/".*/, "", header)
    if (header ~ /\.c$/) fault("includes a source file: " header)
    split(header, part, "/")
    target = part[1]
    # headers of the server are written from server/ on
    if (!(target in known) && layer == "server") check_room(header, 0)
    else if (!(target in known)) fault("write \"layer/file.h\", not \"" header "\"")
    else if (!((layer, target) in allowed)) fault(layer " must not include " target ": " header)
    else if (layer == target && (layer in has_rooms)) check_room(header, 1)
}

/^[ \t]*#[ \t]*include[ \t]*</ {
    header = $0
    sub(/^[^<]*</, "", header)
    sub(/>.*/, "", header)
    library = library_of(header)
    if (library != "" && index(only[library], " " layer " ") == 0)
        fault(layer " must not include <" header ">: only" only[library] "may")
}

END { exit faults > 0 }
