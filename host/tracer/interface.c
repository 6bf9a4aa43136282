#include "tracer/interface.h"

VkDescriptorType binding_type(uint32_t binding, bool scene_in_storage)
{
    if (binding == RECORDS || binding == RECORD_WORDS)
        return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    return binding >= SURFACES || (binding != VIEW && scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                        : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}
