/* The hex examples of docs/board-protocol.md. */

#ifndef EXAMPLES_H
#define EXAMPLES_H

/* Compares the examples on the page with the codec of this board and prints a line for each. Returns 0 if all agree. */
int check_page(const char *path);

#endif
