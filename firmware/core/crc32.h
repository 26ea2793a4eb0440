#ifndef FIRMWARE_CRC32_H
#define FIRMWARE_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* CRC-32/ISO-HDLC, the CRC of zlib and Ethernet. */
uint32_t crc32(const uint8_t *bytes, size_t length);

#endif
