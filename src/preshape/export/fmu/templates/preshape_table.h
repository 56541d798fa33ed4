/* The shaper of this FMU; see preshape_kernel.h. Written by preshape.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_TABLE_H
#define PRESHAPE_TABLE_H

#define PRESHAPE_TABLE_TOKEN "$token"
#define PRESHAPE_TABLE_DT $dt /* [s] */
#define PRESHAPE_TABLE_TAPS $taps
#define PRESHAPE_TABLE_LONGEST $longest /* the last delay [samples] */

#endif
