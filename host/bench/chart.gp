# gnuplot -c host/bench/chart.gp BENCH.csv CHART.svg
# Time against error of every setting in a CSV file that "vkwhitted bench SCENE --csv BENCH.csv" wrote, of one
# scene. Needs gnuplot 5.4 (Debian: gnuplot-nox).

set datafile separator comma
set datafile missing NaN # does not break a line
set terminal svg size 960,640 dynamic enhanced font "sans-serif,15" background "#ffffff"
set output ARG2

set logscale xy
set format x "10^{%T}"
set format y "%g"
set border 3 lc rgb "#666666"
set tics nomirror
set grid xtics ytics lt 1 lc rgb "#d8d8d8" lw 0.6
set errorbars small
set key outside top left horizontal Left reverse maxrows 3 samplen 1.5
set xlabel "error of 99.9 % of the pixels (linear radiance)"
set ylabel "time, ms"

stats ARG1 using (column("error_absolute_999")) name "error" nooutput
stats ARG1 using (column("time_ms")) name "time" nooutput
seen = ""
stats ARG1 using (scene = strcol("scene"), seen = seen.";".strcol("family")." ".strcol("mode").";", 0) nooutput
set title scene noenhanced

# An error of 0 has no logarithm: it stands at the left edge.
least = error_min > 0 ? error_min : 1e-9
shown(error) = error > 0 ? error : least
width = log(error_max / least)
height = log(time_max / time_min)
set xrange [least * exp(-0.11 * width):error_max * exp(0.12 * width)]
set yrange [time_min * exp(-0.08 * height):time_max * exp(0.08 * height)]

# The colours are Okabe and Ito's, which the colour-blind tell apart; the shapes do without colour, open ones are
# for fast mode.
array family[6] = ["mode", "max-error", "bounces", "light-samples", "samples", "cpu"]
array name[6]   = ["modes", "max error", "bounces", "light samples", "samples a pixel", "CPU"]
array color[6]  = ["#222222", "#0072b2", "#d55e00", "#009e73", "#b4508c", "#777777"]
array shape[6]  = [7, 5, 9, 11, 13, 2]
exact = fast = "" # the numbers of the families that have such settings
do for [i = 1:6] {
    if (strstrt(seen, ";".family[i]." exact;")) { exact = exact." ".i }
    if (strstrt(seen, ";".family[i]." fast;")) { fast = fast." ".i }
}

is(i, mode) = strcol("family") eq family[i + 0] && strcol("mode") eq mode
error_on_front(filtered) = column("pareto") == 1 && (strcol("family") eq "samples") == filtered \
    ? shown(column("error_absolute_999")) : NaN
error_of(i, mode) = is(i, mode) ? shown(column("error_absolute_999")) : NaN

# Labels of the front: those of bounces below to the left, the others above to the right, none upon another.
taken_x = taken_y = ""
is_near(x, y, i) = abs(log(x / word(taken_x, i))) < 0.15 * width && abs(log(y / word(taken_y, i))) < 0.05 * height
is_free(x, y) = (sum [i = 1:words(taken_x)] is_near(x, y, i)) == 0
put(x, y) = is_free(x, y) ? (taken_x = taken_x.sprintf(" %g", x), taken_y = taken_y.sprintf(" %g", y), x) : NaN
side(family) = family eq "bounces" ? -1 : 1
label_error(unused) = column("pareto") == 1 ? put(shown(column("error_absolute_999")), column("time_ms")) : NaN

plot ARG1 using (error_on_front(0)):"time_ms" smooth unique with steps lw 1.5 lc rgb "#808080" title "Pareto front", \
     ARG1 using (error_on_front(1)):"time_ms" smooth unique with steps lw 1.5 dt (6, 4) lc rgb "#b4508c" \
         title "front, samples", \
     for [i in exact] ARG1 using (error_of(i, "exact")):"time_ms":"time_quartiles_ms_1":"time_quartiles_ms_2" \
         with yerrorbars pt shape[i + 0] ps 0.8 lc rgb color[i + 0] title name[i + 0], \
     for [i in fast] ARG1 using (error_of(i, "fast")):"time_ms":"time_quartiles_ms_1":"time_quartiles_ms_2" \
         with yerrorbars pt (shape[i + 0] - 1) ps 0.8 lc rgb color[i + 0] title (i == 1 ? "open: fast" : ""), \
     ARG1 using (label_error(0) * exp(0.06 * width * side(strcol("family")))): \
         (column("time_ms") * exp(0.033 * height * side(strcol("family")))):(strcol("label")) \
         with labels font ",13" noenhanced notitle
