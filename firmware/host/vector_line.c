#include "vector_line.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *current_line;
unsigned line_number, failures, checked;
char conversation[LINE_MOST];

void fail(const char *what)
{
    fprintf(stderr, "line %u: failed check: %s\n    %s", line_number, what, current_line);
    if (conversation[0] != 0)
        fprintf(stderr, "    in: %s", conversation);
    failures++;
}

void expect(bool holds, const char *what)
{
    checked++;
    if (!holds)
        fail(what);
}

const char *value(const char *name)
{
    char key[40];
    snprintf(key, sizeof key, "\"%s\": ", name);
    const char *found = strstr(current_line, key);
    return found == NULL ? NULL : found + strlen(key);
}

long long number(const char *name, size_t index)
{
    const char *at = value(name);
    if (at == NULL) {
        fail(name);
        return 0;
    }
    if (*at == '[')
        at++;
    for (; index > 0 && at != NULL; index--) {
        at = strchr(at, ',');
        if (at != NULL)
            at++;
    }
    return at == NULL ? 0 : strtoll(at, NULL, 10);
}

bool text_is(const char *name, const char *wanted)
{
    const char *at = value(name);
    return at != NULL && *at == '"' && strncmp(at + 1, wanted, strlen(wanted)) == 0 && at[1 + strlen(wanted)] == '"';
}

static unsigned digit(char c)
{
    return (unsigned)(c <= '9' ? c - '0' : c - 'a' + 10);
}

size_t bytes_of(const char *name, uint8_t bytes[BYTES_MOST])
{
    const char *at = value(name);
    size_t length = 0;
    if (at == NULL || *at++ != '"') {
        fail(name);
        return 0;
    }
    for (; at[0] != '"' && length < BYTES_MOST; at += 2)
        bytes[length++] = (uint8_t)(digit(at[0]) << 4 | digit(at[1]));
    return length;
}
