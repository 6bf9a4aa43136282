// Reflection and refraction at a smooth surface between vacuum and a body of index of refraction ior.

real3 reflected(real3 direction, real3 facing_normal, real cos_in)
{
    exact real3 mirrored = direction + (real(2) * cos_in) * facing_normal;
    return renormalized(mirrored);
}

struct Refraction {
    bool total;        // total internal reflection: no refracted ray
    real reflectance;  // Fresnel's k_r for unpolarised light
    real3 direction;   // of the refracted ray
};

// eta = n1 / n2 and kappa = 1 - eta^2, both from the scene. With kappa the terms that cancel for ior near 1
// and near normal incidence never are subtracted: eta cos_in - cos_out = -kappa / (eta cos_in + cos_out).
Refraction refracted(real3 direction, real3 facing_normal, real cos_in, real eta, real kappa)
{
    exact real eta_cos = eta * cos_in;
    exact real cos_out_squared = kappa + eta_cos * eta_cos;
    bool total = !(cos_out_squared > real(0));
    exact real cos_out = square_root(total ? real(1) : cos_out_squared);
    exact real cosine_sum = eta_cos + cos_out;
    exact real bend = divide(kappa, cosine_sum);
    exact real3 bent = eta * direction - bend * facing_normal;

    // r_s = (eta cos_in - cos_out) / (eta cos_in + cos_out), r_p = r_s cos(i + o) / cos(i - o)
    exact real r_s = divide(bend, cosine_sum);
    exact real cosines = cos_in * cos_out;
    exact real sines = eta * (real(1) - cos_in * cos_in);
    exact real below = cosines - sines;
    exact real above = cosines + sines;
    exact real ratio = divide(below, above);
    exact real reflectance = (real(0.5) * (r_s * r_s)) * (real(1) + ratio * ratio);
    return Refraction(total, reflectance, renormalized(bent));
}
