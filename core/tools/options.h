/* SPDX-License-Identifier: GPL-3.0-or-later
 * Values of command-line options. Each parser reports a bad value with the option's name and what is allowed. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "tool.h"

bool parse_count(const char *option, const char *text, uint32_t minimum, uint32_t maximum, uint32_t *value);
bool parse_real(const char *option, const char *text, double minimum, double maximum, double *value);
/* "WIDTHxHEIGHT" */
bool parse_size(const char *option, const char *text, uint32_t size[2]);
/* "X,Y,WIDTH,HEIGHT" */
bool parse_crop(const char *option, const char *text, uint32_t crop[4]);
/* Flags (enum pnb_pass) of the named pass; "Shadow.<light>" is one of LIGHT_SHADOWS. */
bool parse_pass(const char *option, const char *text, uint32_t *passes);

/* A technique by its identifier in any case. `technique` is its index. */
bool parse_technique(const char *option, const char *text, uint32_t *technique);
/* Identifier of a technique, a static string. */
const char *technique_id(uint32_t technique);

/* "name=value" for a parameter of a technique: a number in its range, true or false, or the name of an item.
 * `known` tells whether the technique has that parameter; where it has not, nothing is reported. */
bool parse_assignment(const char *text, uint32_t technique, pnb_value *value, bool *known);
/* Reports that the technique has no such parameter, and which it has. Returns false. */
bool report_unknown_parameter(const char *assignment, uint32_t technique);

#endif
