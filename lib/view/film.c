/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/array.h"
#include "base/number_text.h"
#include "view/edge_smoothing.h"
#include "view/film.h"

enum { ARGS_MAX = 40, PATH_LEN = 4096 };

/* Path of a program on the PATH; NULL: none. */
static const char *find_program(const char *name, char path[PATH_LEN])
{
    const char *all = getenv("PATH");
    while (all && *all) {
        const size_t n = strcspn(all, ":");
        if (n && snprintf(path, PATH_LEN, "%.*s/%s", (int)n, all, name) < PATH_LEN && access(path, X_OK) == 0)
            return path;
        all += n + (all[n] == ':');
    }
    return NULL;
}

int fl_film_has_ffmpeg(void)
{
    char path[PATH_LEN];
    return find_program("ffmpeg", path) != NULL;
}

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : "";
}

/* Starts ffmpeg with a pipe to its standard input. */
static int start(fl_film *f, char *const *args, fl_err *err)
{
    char program[PATH_LEN];
    int ends[2];
    if (!find_program("ffmpeg", program))
        return fl_fail(err, FL_SYSTEM, "%s: ffmpeg is not on the PATH (package ffmpeg)", f->path);
    if (pipe(ends) != 0) return fl_fail(err, FL_SYSTEM, "a pipe to ffmpeg: %s", strerror(errno));
    fflush(NULL);
    const pid_t pid = fork();
    if (pid < 0) {
        close(ends[0]);
        close(ends[1]);
        return fl_fail(err, FL_SYSTEM, "ffmpeg does not start: %s", strerror(errno));
    }
    if (pid == 0) {
        const int null = open("/dev/null", O_WRONLY);
        dup2(ends[0], STDIN_FILENO);
        if (null >= 0) dup2(null, STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        signal(SIGINT, SIG_IGN); /* it ends with its input */
        execv(program, args);
        _exit(127);
    }
    close(ends[0]);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    signal(SIGPIPE, SIG_IGN);
    f->pid = pid;
    f->pipe = fdopen(ends[1], "wb");
    return f->pipe ? 0 : fl_fail(err, FL_SYSTEM, "a pipe to ffmpeg: %s", strerror(errno));
}

static int add_args(char *args[ARGS_MAX], int n, const char *const *more)
{
    for (; *more && n < ARGS_MAX - 1; more++) memcpy(&args[n++], more, sizeof *more);
    args[n] = NULL;
    return n;
}

int fl_film_open(fl_film *f, const char *path, int w, int h, double fps, fl_err *err)
{
    const char *end = ending_of(path);
    const int avi = strcmp(end, "avi") == 0;
    char size[40], rate[FL_NUMBER_LEN], *args[ARGS_MAX];
    *f = (fl_film){.path = path, .w = w, .h = h};
    if (!avi && strcmp(end, "mp4") != 0 && strcmp(end, "mkv") != 0 && strcmp(end, "mov") != 0)
        return fl_fail(err, FL_USAGE, "%s: a film ends in .mp4, .mkv, .mov or .avi", path);
    if (w % 2 || h % 2)
        return fl_fail(err, FL_USAGE, "%s: the size of a film is even, %dx%d is not", path, w, h);
    f->part = fl_alloc((int64_t)strlen(path) + 12, 1, err);
    if (!f->part) return -1;
    sprintf(f->part, "%.*s.part.%s", (int)(end - path - 1), path, end);
    f->yuv = fl_alloc((int64_t)w * h * 3 / 2, 1, err);
    if (!f->yuv) goto fail;
    const int test =
        open(f->part, O_WRONLY | O_CREAT, 0666); /* so that a name that cannot be written is told before */
    if (test < 0) {
        fl_fail(err, FL_SYSTEM, "%s: %s", f->part, strerror(errno));
        goto fail;
    }
    close(test);
    snprintf(size, sizeof size, "%dx%d", w, h);
    const char *const in[] = {"ffmpeg",       "-y",       "-v",          "error",
                              "-f",           "rawvideo", "-pix_fmt",    "yuv420p",
                              "-s",           size,       "-r",          fl_number_text(fps, rate),
                              "-color_range", "tv",       "-colorspace", "bt709",
                              "-i",           "-",        NULL};
    const char *const x264[] = {
        "-c:v",        "libx264", "-preset",          "veryfast",   "-crf",       "21",
        "-pix_fmt",    "yuv420p", "-color_primaries", "bt709",      "-color_trc", "bt709",
        "-colorspace", "bt709",   "-movflags",        "+faststart", f->part,      NULL};
    const char *const mjpeg[] = {"-c:v", "mjpeg", "-q:v", "4", "-pix_fmt", "yuvj420p", f->part, NULL};
    add_args(args, add_args(args, 0, in), avi ? mjpeg : x264);
    if (start(f, args, err)) goto fail;
    return 0;
fail:
    fl_film_abort(f);
    return -1;
}

int fl_film_add(fl_film *f, const fl_picture *p, fl_err *err)
{
    fl_picture_to_yuv(p->px, f->w, f->h, f->yuv);
    const size_t n = (size_t)f->w * (size_t)f->h * 3 / 2;
    if (fwrite(f->yuv, 1, n, f->pipe) == n) return 0;
    return fl_fail(err, FL_SYSTEM, "%s: ffmpeg takes no more frames", f->path);
}

static int wait_for(fl_film *f)
{
    int status = -1;
    if (f->pipe) fclose(f->pipe);
    f->pipe = NULL;
    if (f->pid > 0)
        while (waitpid((pid_t)f->pid, &status, 0) < 0 && errno == EINTR) {}
    f->pid = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void free_film(fl_film *f)
{
    free(f->part);
    free(f->yuv);
    *f = (fl_film){0};
}

int fl_film_close(fl_film *f, fl_err *err)
{
    const int lost = ferror(f->pipe) || fflush(f->pipe) != 0, status = wait_for(f);
    int rc = 0;
    if (lost || status != 0) rc = fl_fail(err, FL_SYSTEM, "%s: ffmpeg ended with status %d", f->path, status);
    else if (rename(f->part, f->path) != 0) rc = fl_fail(err, FL_SYSTEM, "%s: %s", f->path, strerror(errno));
    if (rc) unlink(f->part);
    free_film(f);
    return rc;
}

void fl_film_abort(fl_film *f)
{
    wait_for(f);
    if (f->part) unlink(f->part);
    free_film(f);
}

int fl_film_jpg(const char *path, const fl_picture *p, fl_err *err)
{
    fl_film f = {.path = path};
    char size[40];
    char *args[ARGS_MAX];
    snprintf(size, sizeof size, "%dx%d", p->w, p->h);
    const char *const in[] = {"ffmpeg", "-y",       "-v",       "error",  "-f",      "rawvideo",  "-pix_fmt",
                              "rgba",   "-s",       size,       "-i",     "-",       "-frames:v", "1",
                              "-q:v",   "2",        "-f",       "image2", "-update", "1",         "-c:v",
                              "mjpeg",  "-pix_fmt", "yuvj420p", path,     NULL};
    const size_t n = 4 * (size_t)p->w * (size_t)p->h;
    add_args(args, 0, in);
    if (start(&f, args, err)) return -1;
    const int lost = fwrite(p->px, 1, n, f.pipe) != n || fflush(f.pipe) != 0, status = wait_for(&f);
    return lost || status != 0
               ? fl_fail(err, FL_SYSTEM, "%s: ffmpeg could not write it, status %d", path, status)
               : 0;
}
