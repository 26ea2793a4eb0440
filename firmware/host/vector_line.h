/* One line of the test vectors at a time: an object of numbers, lists of numbers and texts without escapes. */

#ifndef VECTOR_LINE_H
#define VECTOR_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LINE_MOST = 4096, BYTES_MOST = 1024 };

/* The line that is checked, and the conversation that it belongs to; empty without one. */
extern const char *current_line;
extern char conversation[LINE_MOST];
extern unsigned line_number;

/* What the checks have found so far. */
extern unsigned failures, checked;

void fail(const char *what);
void expect(bool holds, const char *what);

/* What follows `"name": `; NULL without it. */
const char *value(const char *name);

/* The number, or the `index`th of a list. */
long long number(const char *name, size_t index);

bool text_is(const char *name, const char *wanted);

/* Reads a text of hexadecimal digits. Returns the number of bytes. */
size_t bytes_of(const char *name, uint8_t bytes[BYTES_MOST]);

#endif
