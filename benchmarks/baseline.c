/* The yardstick: the plain C program that one would write by hand for a constant offset.
 *
 *     baseline IN OUT
 *
 * Reads a line, finds its words, reads the coordinates with strtod, adds an offset and writes
 * them with fprintf. Everything else is copied. It keeps no modal state, checks nothing and
 * proves nothing: it is what gcxform's time is compared with, not what it is compared to.
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

static const double offset[3] = {0.125, -0.25, 0.0625}; /* mm, for X, Y and Z */

/* Writes one line with its coordinates shifted. */
static void shift_line(const char *p, FILE *out)
{
    while (*p != '\0') {
        if (*p == '(' || *p == ';') { /* a comment: copied to its end */
            size_t n = *p == '(' ? strcspn(p, ")\n") : strcspn(p, "\n");
            fwrite(p, 1, n, out);
            p += n;
        } else if (*p >= 'X' && *p <= 'Z') {
            char *end;
            double value = strtod(p + 1, &end);
            fputc(*p, out);
            if (end != p + 1)
                fprintf(out, "%.3f", value + offset[*p - 'X']);
            p = end;
        } else {
            fputc(*p++, out);
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: baseline IN OUT\n");
        return 2;
    }
    FILE *in = fopen(argv[1], "r");
    if (in == NULL) {
        perror(argv[1]);
        return 5;
    }
    FILE *out = fopen(argv[2], "w");
    if (out == NULL) {
        perror(argv[2]);
        return 5;
    }
    char *line = NULL;
    size_t room = 0;
    while (getline(&line, &room, in) != -1)
        shift_line(line, out);
    int bad = ferror(in) | ferror(out);
    free(line);
    bad |= fclose(in) | fclose(out);
    if (bad)
        perror("baseline");
    return bad ? 5 : 0;
}
