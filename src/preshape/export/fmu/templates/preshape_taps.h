/* The taps of this FMU's shaper, for preshape_fmu.c alone. Written by preshape.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
static const uint32_t DELAYS[PRESHAPE_TABLE_TAPS] = { /* [samples] */
    $delays};
static const preshape_real WEIGHTS[PRESHAPE_TABLE_TAPS] = { /* [-], of sum 1 */
    $weights};
