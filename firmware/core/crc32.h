#ifndef FIRMWARE_CRC32_H
#define FIRMWARE_CRC32_H

#include <stdint.h>

/* CRC-32/ISO-HDLC, the CRC of zlib and Ethernet, byte by byte: it starts as CRC32_START, crc32_add adds a byte, and the
   complement of the result is the checksum. */
#define CRC32_START 0xFFFFFFFFu
uint32_t crc32_add(uint32_t crc, uint8_t byte);

/* The result of crc32_add after any bytes and their correct checksum, low byte first. The result does not depend on the
   bytes. */
#define CRC32_WITH_CHECK 0xDEBB20E3u

#endif
