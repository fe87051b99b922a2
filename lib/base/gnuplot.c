/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/gnuplot.h"

enum { PATH_LEN = 4096 };

/* Runs gnuplot in the folder dir.  message receives its stderr.  Returns its exit status, or -1. */
static int run_gnuplot(const char *dir, const char *setting, const char *script, char *message, size_t size)
{
    int pipe_fd[2], status = 0;
    size_t have = 0;
    ssize_t k;
    message[0] = '\0';
    if (pipe(pipe_fd) != 0) return -1;
    const pid_t pid = fork();
    if (pid < 0) {
        close(pipe_fd[0]);
        close(pipe_fd[1]);
        return -1;
    }
    if (pid == 0) {
        const int null = open("/dev/null", O_RDWR);
        if (null < 0 || dup2(null, 0) < 0 || dup2(null, 1) < 0 || dup2(pipe_fd[1], 2) < 0 || chdir(dir) != 0)
            _exit(126);
        close(pipe_fd[0]);
        /* -d: a start-up file of the user must not change the picture */
        execlp("gnuplot", "gnuplot", "-d", "-e", setting, script, (char *)NULL);
        _exit(errno == ENOENT ? 127 : 126);
    }
    close(pipe_fd[1]);
    for (;;) {
        char more[512];
        k = read(pipe_fd[0], more, sizeof more);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) break;
        for (ssize_t j = 0; j < k && have + 1 < size; j++) message[have++] = more[j];
    }
    message[have] = '\0';
    close(pipe_fd[0]);
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int fl_gnuplot_is_there(void)
{
    char message[200];
    return run_gnuplot(".", "exit", "/dev/null", message, sizeof message) == 0;
}

/* The last line of gnuplot's stderr that is not empty: it names the error. */
static const char *last_error_line(char *message)
{
    const char *last = "no reason given";
    for (char *line = strtok(message, "\r\n"); line; line = strtok(NULL, "\r\n"))
        if (line[strspn(line, " \t^")]) last = line + strspn(line, " \t");
    return last;
}

/* gnuplot draws to NAME.part, which gets its final name when the picture is complete. */
int fl_gnuplot_draw(const char *dir, const char *stem, const char *format, fl_err *err)
{
    char script[FL_GNUPLOT_STEM + 8], setting[FL_GNUPLOT_STEM + 24], part[PATH_LEN], path[PATH_LEN],
        message[2000];
    struct stat st;
    snprintf(script, sizeof script, "%s.gp", stem);
    snprintf(setting, sizeof setting, "out = '%s.%s.part'", stem, format);
    if (snprintf(path, sizeof path, "%s/%s.%s", dir, stem, format) >= PATH_LEN - 8)
        return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", dir);
    snprintf(part, sizeof part, "%s/%s.%s.part", dir, stem, format);
    const int status = run_gnuplot(dir, setting, script, message, sizeof message);
    if (status == 127) return fl_fail(err, FL_SYSTEM, "gnuplot was not found: --plot needs it");
    if (status != 0 || stat(part, &st) != 0 || st.st_size == 0) {
        unlink(part);
        return fl_fail(err, FL_SYSTEM, "gnuplot failed on %s/%s: %.200s", dir, script,
                       last_error_line(message));
    }
    return rename(part, path) == 0 ? 0 : fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
}
