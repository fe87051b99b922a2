/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _DEFAULT_SOURCE /* sigaltstack, setrlimit, with any C library */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "support/fuzz.h"
#include "support/verify.h"

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

enum {
    SECONDS = 30, /* processor time for one input: corpora are kilobytes, a reader takes milliseconds */
    GROWN_MAX = 1 << 20, /* largest size of a damaged copy */
    WORK = 64 << 20      /* bytes of damaged copies per file: 4000 copies of 16 kB */
};
#define MEMORY ((rlim_t)2 << 30)

typedef struct {
    char *name;
    unsigned char *data;
    int32_t n, cap;
} bytes;

fuzz_fn *fuzz_target;
static bytes *corpus;
static int32_t files, files_cap;
static char now[700]; /* the current input, for the signal handler */
static char scratch[600];
static int scratch_fd = -1;

static void say(const char *s)
{
    const ssize_t ignored = write(STDERR_FILENO, s, strlen(s));
    (void)ignored;
}

static void on_signal(int sig)
{
    say(sig == SIGPROF ? "took more than 30 s of processor time: " : "crashed: ");
    say(now);
    say("\n");
    if (scratch_fd >= 0) unlink(scratch);
    signal(sig, SIG_DFL);
    if (sig == SIGPROF) _exit(1);
    raise(sig);
}

static void on_exit_remove(void)
{
    if (scratch_fd >= 0) unlink(scratch);
}

static _Noreturn void die(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, strerror(errno));
    exit(4);
}

#ifdef SANITIZED
void __sanitizer_set_death_callback(void (*callback)(void));
static void on_sanitizer(void)
{
    say("stopped by the sanitizer: ");
    say(now);
    say("\n");
}
#endif

static void watch(void)
{
    static unsigned char stack[1 << 16];
    const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF};
    const stack_t alt = {.ss_sp = stack, .ss_size = sizeof stack};
    struct sigaction act = {.sa_handler = on_signal, .sa_flags = SA_ONSTACK};
    sigaltstack(&alt, NULL);
#ifdef SANITIZED
    __sanitizer_set_death_callback(on_sanitizer);
    sigaction(SIGPROF, &act, NULL);
    (void)fatal;
#else
    const struct rlimit room = {MEMORY, MEMORY};
    setrlimit(RLIMIT_AS, &room);
    for (size_t k = 0; k < sizeof fatal / sizeof *fatal; k++) sigaction(fatal[k], &act, NULL);
#endif
}

int fuzz_verdict(int rc, const fl_err *err)
{
    if (rc == 0) return err->code == 0 ? FUZZ_READ : FUZZ_BROKEN;
    if (rc != -1 || err->code < FL_NO || err->code > FL_NUMERIC) return FUZZ_BROKEN;
    if (err->text[0] == '\0' || strchr(err->text, '\n')) return FUZZ_BROKEN;
    return err->code == FL_SYSTEM ? FUZZ_SYSTEM : FUZZ_REFUSED;
}

const char *fuzz_file(const unsigned char *data, size_t n)
{
    if (scratch_fd < 0) {
        const char *folder = getenv("TMPDIR");
        snprintf(scratch, sizeof scratch, "%s/floe-fuzz-XXXXXX", folder && *folder ? folder : "/tmp");
        scratch_fd = mkstemp(scratch);
        if (scratch_fd < 0) die(scratch);
        atexit(on_exit_remove);
    }
    if (ftruncate(scratch_fd, 0) != 0) die(scratch);
    for (size_t done = 0; done < n;) {
        const ssize_t k = pwrite(scratch_fd, data + done, n - done, (off_t)done);
        if (k <= 0) die(scratch);
        done += (size_t)k;
    }
    return scratch;
}

/* --- bytes -------------------------------------------------------------------------------------------- */

/* Replaces `cut` bytes at `from` by put[n]. */
static void splice(bytes *b, int32_t from, int32_t cut, const void *put, int32_t n)
{
    fl_err err = {0};
    const int64_t size = (int64_t)b->n - cut + n;
    if (size > GROWN_MAX) return;
    if (fl_grow(&b->data, &b->cap, size + 1, 1, &err)) die(err.text);
    memmove(b->data + from + n, b->data + from + cut, (size_t)(b->n - from - cut));
    if (n) memcpy(b->data + from, put, (size_t)n);
    b->n = (int32_t)size;
}

static bytes load(const char *path, const char *name)
{
    bytes b = {0};
    unsigned char buf[4096];
    size_t k;
    fl_err err = {0};
    FILE *f = fopen(path, "rb");
    if (!f) die(path);
    b.name = strdup(name);
    if (!b.name || fl_grow(&b.data, &b.cap, 1, 1, &err)) die(path);
    while ((k = fread(buf, 1, sizeof buf, f)) > 0) {
        if (fl_grow(&b.data, &b.cap, (int64_t)b.n + (int64_t)k, 1, &err)) die(err.text);
        memcpy(b.data + b.n, buf, k);
        b.n += (int32_t)k;
    }
    if (ferror(f)) die(path);
    fclose(f);
    return b;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const bytes *)a)->name, ((const bytes *)b)->name);
}

static void load_corpus(const char *folder)
{
    const struct dirent *e;
    fl_err err = {0};
    DIR *d = opendir(folder);
    if (!d) die(folder);
    while ((e = readdir(d)) != NULL) {
        char path[1024];
        if (e->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (fl_grow(&corpus, &files_cap, files + 1, sizeof *corpus, &err)) die(err.text);
        corpus[files++] = load(path, e->d_name);
    }
    closedir(d);
    if (files) qsort(corpus, (size_t)files, sizeof *corpus, compare_names);
}

/* --- damage ------------------------------------------------------------------------------------------- */

static int32_t below(fl_rng *g, int32_t n) { return n > 0 ? (int32_t)(fl_rng_u64(g) % (uint64_t)n) : 0; }

/* The line at a random position: its first byte, and its length with the newline. */
static int32_t some_line(const bytes *b, fl_rng *g, int32_t *len)
{
    int32_t from = below(g, b->n), to = from;
    while (from > 0 && b->data[from - 1] != '\n') from--;
    while (to < b->n && b->data[to] != '\n') to++;
    *len = (to < b->n ? to + 1 : to) - from;
    return from;
}

static int in_number(unsigned char c)
{
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
}

static void swap_number(bytes *b, fl_rng *g)
{
    static const char *const odd[] = {"-1",
                                      "0",
                                      "1e309",
                                      "nan",
                                      "inf",
                                      "-inf",
                                      "2147483647",
                                      "2147483648",
                                      "-2147483649",
                                      "4294967295",
                                      "1e-320",
                                      "0x10",
                                      "",
                                      "-0",
                                      "9223372036854775808",
                                      "1e300",
                                      "1.2.3",
                                      "1000000000",
                                      "-1000000000",
                                      "1e",
                                      "65536",
                                      "0.1",
                                      "99999999999999999999",
                                      "1;2"};
    int32_t from = below(g, b->n), to;
    while (from < b->n && !in_number(b->data[from])) from++;
    while (from > 0 && in_number(b->data[from - 1])) from--;
    to = from;
    while (to < b->n && in_number(b->data[to])) to++;
    const char *put = odd[below(g, (int32_t)(sizeof odd / sizeof *odd))];
    splice(b, from, to - from, put, (int32_t)strlen(put));
}

static void damage_once(bytes *b, fl_rng *g)
{
    unsigned char part[4096];
    int32_t len, at, k;
    if (b->n == 0) {
        k = 1 + below(g, 64);
        for (int32_t i = 0; i < k; i++) part[i] = (unsigned char)fl_rng_u64(g);
        splice(b, 0, 0, part, k);
        return;
    }
    switch (below(g, 14)) {
    case 0: /* some bits */
        for (k = 1 + below(g, 8); k > 0; k--) {
            at = below(g, b->n);
            b->data[at] = (unsigned char)(b->data[at] ^ 1u << below(g, 8));
        }
        break;
    case 1: b->n = below(g, b->n); break;
    case 2: /* a line repeated, once or very often */
        at = some_line(b, g, &len);
        if (len > (int32_t)sizeof part) break;
        memcpy(part, b->data + at, (size_t)len);
        for (k = below(g, 8) ? 1 : 1 + below(g, 300); k > 0; k--) splice(b, at, 0, part, len);
        break;
    case 3:
        at = some_line(b, g, &len);
        splice(b, at, len, NULL, 0);
        break;
    case 4: /* a line moved */
        at = some_line(b, g, &len);
        if (len > (int32_t)sizeof part) break;
        memcpy(part, b->data + at, (size_t)len);
        splice(b, at, len, NULL, 0);
        at = b->n ? some_line(b, g, &k) : 0;
        splice(b, at, 0, part, len);
        break;
    case 5:
    case 6:
    case 7:
    case 8: swap_number(b, g); break;
    case 9: { /* a piece of another file of the corpus, in place of as many bytes */
        const bytes *o = &corpus[below(g, files)];
        len = o->n ? 1 + below(g, o->n < 4096 ? o->n : 4096) : 0;
        at = below(g, b->n);
        splice(b, at, below(g, 2) ? 0 : (len < b->n - at ? len : b->n - at),
               o->data + below(g, o->n - len + 1), len);
        break;
    }
    case 10: /* random bytes */
        len = 1 + below(g, 16);
        for (int32_t i = 0; i < len; i++) part[i] = (unsigned char)fl_rng_u64(g);
        splice(b, below(g, b->n), 0, part, len);
        break;
    case 11: { /* a binary count */
        static const uint32_t count[] = {0,           1,           0x7fffffffu, 0x80000000u,
                                         0xffffffffu, 0x10000000u, 0x7fc00000u};
        if (b->n < 4) break;
        memcpy(b->data + below(g, b->n - 3), &count[below(g, 7)], 4);
        break;
    }
    case 12: /* a word removed */
        at = below(g, b->n);
        for (len = 0; at + len < b->n && b->data[at + len] > ' '; len++) continue;
        splice(b, at, len, NULL, 0);
        break;
    default: /* a blank, a carriage return, a nul */
        part[0] = (unsigned char)" \t\r\n#=\0;"[below(g, 8)];
        splice(b, below(g, b->n), 0, part, 1);
    }
}

/* Damaged copy m of a file: a function of the file, its name and m. */
static void damage(bytes *out, const bytes *file, int64_t m)
{
    fl_rng g = fl_rng_of(fl_hash(FL_HASH_START, file->name, (int64_t)strlen(file->name)), m, FL_RNG_TEST);
    out->n = 0;
    splice(out, 0, 0, file->data, file->n);
    for (int32_t k = 1 + below(&g, 4); k > 0; k--) damage_once(out, &g);
}

/* --- a file of the corpus ----------------------------------------------------------------------------- */

/* Processor time, not elapsed time: the load of the machine must not fail a reader. */
static void limit_time(time_t seconds)
{
    const struct itimerval limit = {.it_value.tv_sec = seconds};
    setitimer(ITIMER_PROF, &limit, NULL);
}

/* The reader gets a copy of exactly n bytes, so that the sanitizer detects reads beyond the end. */
static int run_input(fuzz_fn *one, const bytes *b)
{
    unsigned char *copy = malloc((size_t)b->n + (b->n == 0));
    if (!copy) die("memory");
    if (b->n) memcpy(copy, b->data, (size_t)b->n);
    limit_time(SECONDS);
    const int verdict = one(copy, (size_t)b->n);
    limit_time(0);
    free(copy);
    return verdict;
}

static const char *verdict_text(int verdict)
{
    return verdict == FUZZ_READ      ? "read"
           : verdict == FUZZ_REFUSED ? "refused"
           : verdict == FUZZ_SYSTEM  ? "out of memory or another failure of the system"
                                     : "return value and error disagree, or a postcondition is violated";
}

static int complain(int verdict)
{
    printf("%s: %s\n", now, verdict_text(verdict));
    fflush(stdout);
    return -1;
}

static int replay(const char *name, const bytes *b, fuzz_fn *one, int *verdict)
{
    snprintf(now, sizeof now, "tests/fuzz/%s/%s unchanged", name, b->name);
    *verdict = run_input(one, b);
    if (*verdict != FUZZ_READ && *verdict != FUZZ_REFUSED) return complain(*verdict);
    if (strncmp(b->name, "good", 4) == 0 && *verdict != FUZZ_READ) return complain(*verdict);
    if (strncmp(b->name, "bad", 3) == 0 && *verdict != FUZZ_REFUSED) return complain(*verdict);
    return 0;
}

static int replay_damaged(const char *name, const bytes *b, fuzz_fn *one, int64_t copies, bytes *work)
{
    for (int64_t m = 0; m < copies; m++) {
        snprintf(now, sizeof now, "tests/fuzz/%s/%s damaged (fuzz_%s --print tests/fuzz/%s/%s %lld)", name,
                 b->name, name, name, b->name, (long long)m);
        damage(work, b, m);
        const int verdict = run_input(one, work);
        if (verdict != FUZZ_READ && verdict != FUZZ_REFUSED) return complain(verdict);
    }
    return 0;
}

/* The first 200 allocations fail one by one, then a sample: the rest are repetitions of the same rows. */
static int replay_starved(const char *name, const bytes *b, fuzz_fn *one, int usual)
{
    for (long k = 0;; k += k < 200 ? 1 : k / 8) {
        snprintf(now, sizeof now, "tests/fuzz/%s/%s with allocation %ld failing", name, b->name, k);
        fl_alloc_fail_after(k);
        const int verdict = run_input(one, b);
        const long refused = fl_alloc_refused();
        fl_alloc_fail_after(-1);
        if (refused == 0) return verdict == usual ? 0 : complain(verdict);
        if (verdict != FUZZ_SYSTEM && !(verdict == FUZZ_REFUSED && usual == FUZZ_REFUSED))
            return complain(verdict);
    }
}

static int print_copy(const char *path, const char *number)
{
    uint64_t m = 0;
    char folder[1024];
    const char *slash = strrchr(path, '/');
    bytes work = {0};
    if (fl_number_u64(number, &m)) {
        fprintf(stderr, "\"%s\" is not the number of a copy\n", number);
        return 2;
    }
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) : 1, slash ? path : ".");
    load_corpus(folder); /* splices use the whole corpus */
    for (int32_t f = 0; f < files; f++)
        if (strcmp(corpus[f].name, slash ? slash + 1 : path) == 0) damage(&work, &corpus[f], (int64_t)m);
    if (!work.data) die(path);
    return fwrite(work.data, 1, (size_t)work.n, stdout) == (size_t)work.n ? 0 : 4;
}

int fuzz_main(int argc, char **argv, const char *name, fuzz_fn *one)
{
    const char *asked = getenv("FLOE_FUZZ");
    char folder[600];
    uint64_t most = verify_quick() ? 400 : 4000;
    int failed = 0;
    bytes work = {0};
    fuzz_target = one;
    if (argc == 0) return 0;
    if (argc == 4 && strcmp(argv[1], "--print") == 0) return print_copy(argv[2], argv[3]);
    if (argc > 2 || (asked && fl_number_u64(asked, &most))) {
        fprintf(stderr, "usage: fuzz_%s [FOLDER] | --print FILE M; FLOE_FUZZ, if set, is a number\n", name);
        return 2;
    }
    snprintf(folder, sizeof folder, "tests/fuzz/%s", name);
    load_corpus(argc == 2 ? argv[1] : folder);
    watch();
    for (int32_t f = 0; f < files; f++) {
        const bytes *b = &corpus[f];
        int64_t copies = (int64_t)most;
        int usual = 0;
        if (!asked && copies > WORK / (b->n + 1)) copies = WORK / (b->n + 1);
        failed += replay(name, b, one, &usual) || replay_damaged(name, b, one, copies, &work) ||
                  replay_starved(name, b, one, usual);
    }
    for (int32_t f = 0; f < files; f++) {
        free(corpus[f].name);
        free(corpus[f].data);
    }
    printf("%d passed, %d failed\n", files - failed, failed);
    if (files == 0) fprintf(stderr, "%s holds no corpus\n", argc == 2 ? argv[1] : folder);
    free(corpus);
    free(work.data);
    return failed || files == 0;
}
