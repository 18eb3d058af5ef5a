// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/listen.h"

#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/// A new connection beyond the backlog is dropped and tries again after a second: a class that
/// opens the page at one instant must fit in.
enum { BACKLOG = 1024, FIRST_OPEN_PORT = 1024, LAST_PORT = 65535 };

static void set_port(struct sockaddr *address, int port) {
    if (address->sa_family == AF_INET6) {
        ((struct sockaddr_in6 *)address)->sin6_port = htons((uint16_t)port);
    } else {
        ((struct sockaddr_in *)address)->sin_port = htons((uint16_t)port);
    }
}

static int get_port(int fd) {
    struct sockaddr_storage name;
    socklen_t size = sizeof name;
    if (getsockname(fd, (struct sockaddr *)&name, &size) != 0) {
        return 0;
    }
    return ntohs(name.ss_family == AF_INET6 ? ((struct sockaddr_in6 *)&name)->sin6_port
                                            : ((struct sockaddr_in *)&name)->sin_port);
}

/// A listening socket, or -1 with errno.
static int open_socket(const struct addrinfo *where) {
    int fd = socket(where->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), on = 1;
    if (fd < 0) {
        return -1;
    }
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, where->ai_addr, where->ai_addrlen) != 0 || listen(fd, BACKLOG) != 0) {
        int reason = errno;
        close(fd);
        errno = reason;
        return -1;
    }
    return fd;
}

static hn_status tell_why(int reason, const char *host, int first, int last, hn_diag *diag) {
    if (reason == EACCES && first < FIRST_OPEN_PORT) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, "take --port 8080",
                           "port %d is reserved for the system (ports below %d are)", first,
                           FIRST_OPEN_PORT);
    }
    if (reason == EADDRNOTAVAIL) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, "leave --host out to listen on 127.0.0.1",
                           "%.100s is not an address of this machine", host);
    }
    if (reason == EADDRINUSE) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, "take --port 0 for any free one",
                           first == last ? "port %d is taken" : "ports %d to %d are taken", first,
                           last);
    }
    return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot listen on %.100s port %d: %s", host,
                       first, strerror(reason));
}

static void write_address(const struct addrinfo *where, char address[256]) {
    char name[200] = "127.0.0.1";
    getnameinfo(where->ai_addr, where->ai_addrlen, name, sizeof name, NULL, 0, NI_NUMERICHOST);
    snprintf(address, 256, where->ai_family == AF_INET6 ? "[%s]" : "%s", name);
}

hn_status hn_listen(const char *host, int port, int next_ports, int *fd, int *bound,
                    char address[256], hn_diag *diag) {
    struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE}, *where = NULL;
    int fault = getaddrinfo(host, "0", &hints, &where);
    if (fault != 0) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, "leave --host out to listen on 127.0.0.1",
                           "the host '%.100s' is unknown: %s", host, gai_strerror(fault));
    }

    // the port asked for, or one of the next
    int last = port + (port > 0 ? next_ports : 0);
    last = last > LAST_PORT ? LAST_PORT : last;
    int reason = EADDRINUSE, socket_fd = -1;
    for (int p = port; p <= last && socket_fd < 0 && reason == EADDRINUSE; p++) {
        set_port(where->ai_addr, p);
        socket_fd = open_socket(where);
        reason = socket_fd < 0 ? errno : 0;
    }

    // how a link names the address
    if (socket_fd >= 0) {
        *fd = socket_fd;
        *bound = get_port(socket_fd);
        write_address(where, address);
    }
    freeaddrinfo(where);
    return socket_fd >= 0 ? HN_OK : tell_why(reason, host, port, last, diag);
}
