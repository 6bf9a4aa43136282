#!/bin/bash
# check_spirv.sh MODULE.spv...: each is valid for Vulkan 1.2, and each of its floating-point operations carries
# NoContraction, so that no compiler may fuse or reorder it; of the functions that need not be correctly rounded none
# is used, but the square root, which the arithmetic contract answers for.
set -u
status=0
for module in "$@"; do
    spirv-val --target-env vulkan1.2 "$module" || { echo "$module: not valid"; status=1; }
    text=$(spirv-dis --no-color "$module") || { echo "$module: cannot be read"; status=1; continue; }
    awk -v module="$module" '
        $1 == "OpDecorate" && $3 == "NoContraction" { exact[$2] = 1 }
        $1 == "OpName" { named[$2] = $3 }
        $3 == "OpFunction" { name = named[$1] }
        name ~ /^"estimate_of\(/ { next } # scales by a power of two, which rounds nothing
        # %id = OpFAdd ...; comparisons (OpFOrd, OpFUnord), conversions and copies round nothing
        $3 ~ /^Op(FAdd|FSub|FMul|FDiv|FNegate|VectorTimesScalar|VectorTimesMatrix|MatrixTimes.*|OuterProduct)$/ {
            ++operations
            if (!exact[$1]) { print module ": " name ": " $3 " without NoContraction"; bad = 1 }
        }
        $3 ~ /^Op(Dot|FRem|FMod|Quantize.*)$/ { print module ": " name ": " $3; bad = 1 }
        $3 == "OpExtInst" && $6 !~ /^(Sqrt|[FSU](Abs|Sign)|Find[ISU].*|[SU](Min|Max|Clamp))$/ {
            print module ": " name ": " $6; bad = 1
        }
        END {
            if (operations < 50) { print module ": only " operations + 0 " operations found"; bad = 1 }
            exit bad
        }' <<<"$text" || status=1
done
exit $status
