// Loaded into a process by LD_PRELOAD, it makes the system misbehave below a folder (FAULT_ROOT):
//   FAULT_FULL    while this file exists, no file below FAULT_FULL_UNDER grows: ENOSPC
//   FAULT_SHADOW  folder that receives what a power cut would leave: a file as it was when it was
//                 last synced (file-ID), a folder's entries when that was synced (folder-ID)
//   FAULT_CLOCK   file with the number of seconds by which the wall clock is wrong
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))next_of(#name))

static void* next_of(const char* name) {
  return dlsym(RTLD_NEXT, name);
}

// True where the descriptor is a file or folder at or below `root`.
static int is_below(int descriptor, const char* root) {
  if (root == NULL) return 0;
  char link[64];
  char path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return 0;
  path[length] = '\0';
  const size_t size = strlen(root);
  return strncmp(path, root, size) == 0 && (path[size] == '/' || path[size] == '\0');
}

// --- A full disk ---------------------------------------------------------------------------------

static int is_full(void) {
  const char* flag = getenv("FAULT_FULL");
  return flag != NULL && access(flag, F_OK) == 0;
}

// True where writing up to `end` would make a file of the full disk grow.
static int refuses(int descriptor, off_t end) {
  if (!is_full() || !is_below(descriptor, getenv("FAULT_FULL_UNDER"))) return 0;
  struct stat state;
  if (fstat(descriptor, &state) != 0 || !S_ISREG(state.st_mode)) return 0;
  if (end <= state.st_size) return 0;
  errno = ENOSPC;
  return 1;
}

static off_t place_of(int descriptor) {
  if ((fcntl(descriptor, F_GETFL) & O_APPEND) != 0) return lseek(descriptor, 0, SEEK_END);
  return lseek(descriptor, 0, SEEK_CUR);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  if (is_full() && refuses(descriptor, place_of(descriptor) + (off_t)count)) return -1;
  return NEXT(write)(descriptor, bytes, count);
}

ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  off_t size = 0;
  for (int i = 0; i < count; ++i) size += (off_t)parts[i].iov_len;
  if (is_full() && refuses(descriptor, place_of(descriptor) + size)) return -1;
  return NEXT(writev)(descriptor, parts, count);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at) {
  if (refuses(descriptor, at + (off_t)count)) return -1;
  return NEXT(pwrite)(descriptor, bytes, count, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t at) {
  if (refuses(descriptor, at + (off_t)count)) return -1;
  return NEXT(pwrite64)(descriptor, bytes, count, at);
}

int ftruncate(int descriptor, off_t size) {
  if (refuses(descriptor, size)) return -1;
  return NEXT(ftruncate)(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) {
  if (refuses(descriptor, size)) return -1;
  return NEXT(ftruncate64)(descriptor, size);
}

// --- A power cut ---------------------------------------------------------------------------------

static pthread_mutex_t shadow_mutex = PTHREAD_MUTEX_INITIALIZER;

// Inode and time of birth: an inode's number is used again once its file is gone.
static void identity(int descriptor, const char* name, char* text, size_t size) {
  struct statx state;
  memset(&state, 0, sizeof state);
  statx(descriptor, name, AT_SYMLINK_NOFOLLOW | (*name == '\0' ? AT_EMPTY_PATH : 0),
        STATX_INO | STATX_BTIME | STATX_MODE, &state);
  snprintf(text, size, "%c-%llu-%lld-%u", S_ISDIR(state.stx_mode) ? 'd' : 'f',
           (unsigned long long)state.stx_ino, (long long)state.stx_btime.tv_sec,
           state.stx_btime.tv_nsec);
}

static void keep_file(int descriptor, const char* target) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const int from = open(link, O_RDONLY | O_CLOEXEC);
  const int to = open(target, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  char buffer[65536];
  ssize_t count = 0;
  while (from >= 0 && to >= 0 && (count = read(from, buffer, sizeof buffer)) > 0)
    if (NEXT(write)(to, buffer, (size_t)count) != count) abort();
  if (from >= 0) close(from);
  if (to >= 0) close(to);
}

// One line an entry: identity, tab, name.
static void keep_folder(int descriptor, const char* target) {
  DIR* folder = fdopendir(openat(descriptor, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  FILE* to = fopen(target, "w");
  const struct dirent* entry;
  while (folder != NULL && to != NULL && (entry = readdir(folder)) != NULL) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    char text[128];
    identity(descriptor, entry->d_name, text, sizeof text);
    fprintf(to, "%s\t%s\n", text, entry->d_name);
  }
  if (folder != NULL) closedir(folder);
  if (to != NULL) fclose(to);
}

static void keep(int descriptor) {
  const char* shadow = getenv("FAULT_SHADOW");
  if (shadow == NULL || !is_below(descriptor, getenv("FAULT_ROOT"))) return;
  char name[128];
  char fresh[PATH_MAX];
  char target[PATH_MAX];
  identity(descriptor, "", name, sizeof name);
  snprintf(target, sizeof target, "%s/%s", shadow, name);
  snprintf(fresh, sizeof fresh, "%s/.new", shadow);
  pthread_mutex_lock(&shadow_mutex);
  if (name[0] == 'd')
    keep_folder(descriptor, fresh);
  else
    keep_file(descriptor, fresh);
  rename(fresh, target);
  pthread_mutex_unlock(&shadow_mutex);
}

int fsync(int descriptor) {
  const int state = NEXT(fsync)(descriptor);
  if (state == 0) keep(descriptor);
  return state;
}

int fdatasync(int descriptor) {
  const int state = NEXT(fdatasync)(descriptor);
  if (state == 0) keep(descriptor);
  return state;
}

// --- A clock that is wrong -----------------------------------------------------------------------

static time_t clock_error(void) {
  const char* file = getenv("FAULT_CLOCK");
  if (file == NULL) return 0;
  char text[32] = "";
  const int descriptor = open(file, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  const ssize_t count = read(descriptor, text, sizeof text - 1);
  close(descriptor);
  return count > 0 ? (time_t)atoll(text) : 0;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int state = NEXT(clock_gettime)(clock, now);
  if (state == 0 && clock == CLOCK_REALTIME) now->tv_sec += clock_error();
  return state;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  const int state = NEXT(gettimeofday)(now, zone);
  if (state == 0) now->tv_sec += clock_error();
  return state;
}

time_t time(time_t* now) {
  struct timespec wall;
  clock_gettime(CLOCK_REALTIME, &wall);
  if (now != NULL) *now = wall.tv_sec;
  return wall.tv_sec;
}
