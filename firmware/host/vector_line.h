/* Reads the test vectors one line at a time. A line is a JSON object. Its values are numbers, lists of numbers, and
   strings without escapes. */

#ifndef VECTOR_LINE_H
#define VECTOR_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LINE_MOST = 4096, BYTES_MOST = 1024 };

/* The line under test, and the line that begins its conversation (a sequence of inputs to a board and its responses).
   `conversation` is empty if the line under test belongs to no conversation. */
extern const char *current_line;
extern char conversation[LINE_MOST];
extern unsigned line_number;

/* Counts of failed and of all checks so far. */
extern unsigned failures, checked;

void fail(const char *what);
void expect(bool holds, const char *what);

/* The text after `"name": `, or NULL if the line has no such field. */
const char *value(const char *name);

/* The number in the field `name`. If the field is a list, element `index` of the list. */
long long number(const char *name, size_t index);

bool text_is(const char *name, const char *wanted);

/* Reads a string of hexadecimal digits. Returns the number of bytes. */
size_t bytes_of(const char *name, uint8_t bytes[BYTES_MOST]);

#endif
